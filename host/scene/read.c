#include <errno.h>
#include <math.h>
#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "scene/schema.h"
#include "scene/vector.h"

/* Lengths far from the ends of float's range leave room for squares: 1e15 squared is 1e30. */
#define MOST 1e15
#define LEAST_LENGTH 1e-15

/* Sine of the angle under which two directions count as parallel: some 10 units in float's last place. */
#define LEAST_SINE 1e-6

static const struct bound coordinate[] = {{-MOST, MOST, false, "within -1e15..1e15"}, {.rule = NULL}};
static const struct bound positive_length[] = {
    {0, INFINITY, true, "> 0"}, {LEAST_LENGTH, MOST, false, "within 1e-15..1e15"}, {.rule = NULL}};
static const struct bound field_of_view[] = {{0, 180, true, "> 0 and < 180 degrees"}, {.rule = NULL}};
static const struct bound refraction[] = {
    {0, INFINITY, true, "> 0"}, {1e-3, 1e3, false, "within 0.001..1000"}, {.rule = NULL}};
static const struct bound albedo[] = {{0, 1, false, "within 0..1"}, {.rule = NULL}};
static const struct bound amount[] = {{0, MOST, false, "within 0..1e15"}, {.rule = NULL}};
static const struct bound picture_side[] = {{1, SCENE_MAX_SIZE, false, ""}, {.rule = NULL}};
static const struct bound bounce_count[] = {{0, SCENE_MAX_BOUNCES, false, ""}, {.rule = NULL}};
static const struct bound sample_count[] = {{1, SCENE_MAX_SAMPLES, false, ""}, {.rule = NULL}};

static const struct field scene_fields[] = {
    {"camera", NULL, true, 0, 0, NULL},
    {"image", NULL, true, 0, 0, NULL},
    {"materials", NULL, false, 0, 0, NULL},
    {"objects", NULL, false, 0, 0, NULL},
    {"lights", NULL, false, 0, 0, NULL},
    {"background", read_vector, false, 0, offsetof(struct scene, background), amount},
    {"max_bounces", read_count, false, 0, offsetof(struct scene, max_bounces), bounce_count},
    {"light_samples", read_count, false, 0, offsetof(struct scene, light_samples), sample_count},
    {.name = NULL},
};
static const struct schema scene_schema = {.label = "", .fields = scene_fields};

static const struct field camera_fields[] = {
    {"position", read_vector, true, 0, offsetof(struct scene_camera, position), coordinate},
    {"look_at", read_vector, true, 0, offsetof(struct scene_camera, look_at), coordinate},
    {"up", read_vector, false, 0, offsetof(struct scene_camera, up), NULL},
    {"fov_y", read_number, false, 0, offsetof(struct scene_camera, fov_y_degrees), field_of_view},
    {.name = NULL},
};
static const struct schema camera_schema = {.label = "camera", .fields = camera_fields};

static const struct field image_fields[] = {
    {"width", read_count, true, 0, offsetof(struct scene, width), picture_side},
    {"height", read_count, true, 0, offsetof(struct scene, height), picture_side},
    {.name = NULL},
};
static const struct schema image_schema = {.label = "image", .fields = image_fields};

static const char *const material_types[] = {"matte", "mirror", "transparent", NULL};
enum { MATTE = 1 << MATERIAL_MATTE, TRANSPARENT = 1 << MATERIAL_TRANSPARENT };
static const struct field material_fields[] = {
    {"name", read_name, true, 0, offsetof(struct scene_material, name), NULL},
    {"type", read_type, true, 0, 0, NULL},
    {"color", read_vector, true, MATTE, offsetof(struct scene_material, color), albedo},
    {"roughness", read_number, false, MATTE, offsetof(struct scene_material, roughness), amount},
    {"ior", read_number, false, TRANSPARENT, offsetof(struct scene_material, ior), refraction},
    {.name = NULL},
};
static const struct schema material_schema = {"material", false, material_types, material_fields};

static const char *const object_types[] = {"sphere", "plane", NULL};
enum { SPHERE = 1 << OBJECT_SPHERE, PLANE = 1 << OBJECT_PLANE };
static const struct field object_fields[] = {
    {"name", read_name, true, 0, offsetof(struct scene_object, name), NULL},
    {"type", read_type, true, 0, 0, NULL},
    {"material", NULL, true, 0, 0, NULL},
    {"center", read_vector, true, SPHERE, offsetof(struct scene_object, sphere.center), coordinate},
    {"radius", read_number, true, SPHERE, offsetof(struct scene_object, sphere.radius), positive_length},
    {"point", read_vector, true, PLANE, offsetof(struct scene_object, plane.point), coordinate},
    {"normal", read_vector, true, PLANE, offsetof(struct scene_object, plane.normal), NULL},
    {.name = NULL},
};
static const struct schema object_schema = {"object", true, object_types, object_fields};

static const char *const light_types[] = {"point", "quad", NULL};
enum { POINT = 1 << LIGHT_POINT, QUAD = 1 << LIGHT_QUAD };
static const struct field light_fields[] = {
    {"type", read_type, true, 0, 0, NULL},
    {"color", read_vector, false, 0, offsetof(struct scene_light, color), amount},
    {"power", read_number, true, 0, offsetof(struct scene_light, power), amount},
    {"position", read_vector, true, POINT, offsetof(struct scene_light, point.position), coordinate},
    {"corner", read_vector, true, QUAD, offsetof(struct scene_light, quad.corner), coordinate},
    {"u", read_vector, true, QUAD, offsetof(struct scene_light, quad.u), coordinate},
    {"v", read_vector, true, QUAD, offsetof(struct scene_light, quad.v), coordinate},
    {.name = NULL},
};
static const struct schema light_schema = {"light", false, light_types, light_fields};

/* A material or object by its name; names point into the scene. */
struct named {
    const char *name;
    int line;
    size_t index;
};

struct reading {
    struct diagnostics *report;
    struct scene *scene;
    struct mapping top;
    void *material_names, *object_names; /* of struct named, for tsearch() */
};

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

/* Adds the name of a mapping, if it has a good one, to those before it; refuses one that is among them. */
static void add_name(struct mapping *mapping, const char *name, size_t index, void **names)
{
    if (!name)
        return;
    struct scene_place place = yaml_place(mapping->report, schema_find(mapping, "name").written);
    struct named *named = malloc(sizeof *named), **found = NULL;
    if (named) {
        *named = (struct named){name, place.line, index};
        found = tsearch(named, names, compare_names);
    }
    if (found && *found == named)
        return;
    free(named);
    char quote[REPORT_QUOTE_SIZE];
    if (found)
        report_error(mapping->report, place, "%s name %s is used twice, first in line %d",
                     mapping->schema->label, report_quote(name, strlen(name), quote), (*found)->line);
    else
        mapping->report->no_memory = true;
}

static bool are_parallel(struct dvec3 a, struct dvec3 b)
{
    return dvec3_length(dvec3_cross(dvec3_unit(a), dvec3_unit(b))) <= LEAST_SINE;
}

static void read_camera(struct reading *reading, struct fy_node *node)
{
    struct scene_camera *camera = &reading->scene->camera;
    struct mapping mapping;
    schema_read(reading->report, &camera_schema, node, camera, &mapping);
    if (!mapping.good)
        return;
    struct dvec3 up = dvec3_of(camera->up);
    struct dvec3 view = dvec3_subtract(dvec3_of(camera->look_at), dvec3_of(camera->position));
    struct fy_node *up_node = schema_find(&mapping, "up").written;
    struct fy_node *look_at_node = schema_find(&mapping, "look_at").written;
    if (dvec3_largest(up) == 0)
        schema_refuse(&mapping, up_node, "up must not be zero");
    else if (dvec3_largest(view) == 0)
        schema_refuse(&mapping, look_at_node, "look_at must differ from position");
    else if (are_parallel(view, up))
        schema_refuse(&mapping, up_node ? up_node : look_at_node,
                      "up must not be parallel to the view direction, is [%g, %g, %g]%s", up.x, up.y, up.z,
                      up_node ? "" : " by default");
}

static void read_material(struct reading *reading, struct fy_node *node, size_t index)
{
    struct scene_material *material = &reading->scene->materials[index];
    struct mapping mapping;
    material->ior = 1.3;
    schema_read(reading->report, &material_schema, node, material, &mapping);
    material->type = mapping.type < 0 ? MATERIAL_MATTE : (enum material_type)mapping.type;
    add_name(&mapping, material->name, index, &reading->material_names);
}

static void find_material(struct reading *reading, struct mapping *mapping, struct scene_object *object)
{
    const struct yaml_value value = schema_find(mapping, "material");
    struct named **found = NULL;
    if (!value.written)
        return;
    if (strlen(value.text) == value.length)
        found = tfind(&(struct named){.name = value.text}, &reading->material_names, compare_names);
    if (found)
        object->material = (*found)->index;
    else
        schema_expect(mapping, &value, "material", "the name of a material");
}

static void read_object(struct reading *reading, struct fy_node *node, size_t index)
{
    struct scene_object *object = &reading->scene->objects[index];
    struct mapping mapping;
    schema_read(reading->report, &object_schema, node, object, &mapping);
    object->type = mapping.type < 0 ? OBJECT_SPHERE : (enum object_type)mapping.type;
    add_name(&mapping, object->name, index, &reading->object_names);
    find_material(reading, &mapping, object);
    if (mapping.good)
        object->place = yaml_place(reading->report, node);
    if (mapping.good && object->type == OBJECT_PLANE && dvec3_largest(dvec3_of(object->plane.normal)) == 0)
        schema_refuse(&mapping, schema_find(&mapping, "normal").written, "normal must not be zero");
}

static void read_light(struct reading *reading, struct fy_node *node, size_t index)
{
    struct scene_light *light = &reading->scene->lights[index];
    struct mapping mapping;
    light->color[0] = light->color[1] = light->color[2] = 1;
    schema_read(reading->report, &light_schema, node, light, &mapping);
    light->type = mapping.type < 0 ? LIGHT_POINT : (enum light_type)mapping.type;
    if (mapping.good)
        light->place = yaml_place(reading->report, node);
    if (!mapping.good || light->type != LIGHT_QUAD)
        return;
    struct dvec3 u = dvec3_of(light->quad.u), v = dvec3_of(light->quad.v);
    struct fy_node *u_node = schema_find(&mapping, "u").written, *v_node = schema_find(&mapping, "v").written;
    if (dvec3_largest(u) < LEAST_LENGTH)
        schema_refuse(&mapping, u_node, "u must be at least 1e-15 long");
    if (dvec3_largest(v) < LEAST_LENGTH)
        schema_refuse(&mapping, v_node, "v must be at least 1e-15 long");
    if (mapping.good && are_parallel(u, v))
        schema_refuse(&mapping, v_node, "u and v must not be parallel");
}

/* Makes room for the items of a list, which may be missing or empty, and counts them. */
static void *make_list(struct reading *reading, const char *name, size_t item_size, size_t *count)
{
    const struct yaml_value value = schema_find(&reading->top, name);
    if (!value.written || (value.plain && value.length == 0))
        return NULL;
    if (value.type != FYNT_SEQUENCE)
        schema_expect(&reading->top, &value, name, "a list");
    int items = fy_node_sequence_item_count(value.node);
    void *list = items > 0 ? calloc((size_t)items, item_size) : NULL;
    if (list)
        *count = (size_t)items;
    else if (items > 0)
        reading->report->no_memory = true;
    return list;
}

static void read_items(struct reading *reading, const char *name, size_t count,
                       void (*read_item)(struct reading *, struct fy_node *, size_t))
{
    struct fy_node *list = schema_find(&reading->top, name).node;
    void *at = NULL;
    for (size_t i = 0; i < count && !reading->report->no_memory; i++)
        read_item(reading, fy_node_sequence_iterate(list, &at), i);
}

static void read_root(struct diagnostics *report, struct fy_node *root, struct scene *scene)
{
    struct reading reading = {.report = report, .scene = scene};
    schema_read(report, &scene_schema, root, scene, &reading.top);
    struct fy_node *camera = schema_find(&reading.top, "camera").written;
    struct fy_node *image = schema_find(&reading.top, "image").written;
    struct mapping mapping;
    if (camera)
        read_camera(&reading, camera);
    if (image)
        schema_read(report, &image_schema, image, scene, &mapping);
    scene->materials = make_list(&reading, "materials", sizeof *scene->materials, &scene->material_count);
    scene->objects = make_list(&reading, "objects", sizeof *scene->objects, &scene->object_count);
    scene->lights = make_list(&reading, "lights", sizeof *scene->lights, &scene->light_count);
    read_items(&reading, "materials", scene->material_count, read_material);
    read_items(&reading, "objects", scene->object_count, read_object);
    read_items(&reading, "lights", scene->light_count, read_light);
    tdestroy(reading.material_names, free);
    tdestroy(reading.object_names, free);
}

enum status scene_read_text(const char *path, const char *text, size_t length, struct scene *scene)
{
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    if (length >= 3 && memcmp(text, byte_order_mark, 3) == 0) {
        text += 3;
        length -= 3;
    }
    *scene = (struct scene){
        .path = strdup(path),
        .camera = {.up = {0, 1, 0}, .fov_y_degrees = 60},
        .max_bounces = 5,
        .light_samples = 32,
    };
    struct diagnostics report = {.path = path, .text = text, .length = length, .no_memory = !scene->path};
    struct fy_document *document = yaml_load(&report);
    if (document)
        read_root(&report, fy_document_root(document), scene);
    else if (report.count == 0)
        report_error(&report, (struct scene_place){1, 1},
                     "the file is empty; a scene needs \"camera\" and \"image\"");
    fy_document_destroy(document);

    enum status status = report.no_memory ? STATUS_UNABLE : report.count > 0 ? STATUS_REFUSED : STATUS_DONE;
    report_print(&report);
    if (report.no_memory)
        log_error("no memory to read the scene file %s", path);
    if (status != STATUS_DONE)
        scene_destroy(scene);
    return status;
}

static enum status refuse_file(const char *path, const char *problem)
{
    fprintf(stderr, "%s: error: %s\n", path, problem);
    return STATUS_REFUSED;
}

enum status scene_read(const char *path, struct scene *scene)
{
    *scene = (struct scene){0};
    FILE *file = fopen(path, "rbe");
    if (!file)
        return refuse_file(path, strerror(errno));
    /* Room for all that a scene file may have and one byte more; the pages that stay empty cost nothing. */
    char *text = malloc(SCENE_MAX_FILE_SIZE + 1);
    enum status status = STATUS_UNABLE;
    if (!text) {
        log_error("no memory to read the scene file %s", path);
    } else {
        size_t length = fread(text, 1, SCENE_MAX_FILE_SIZE + 1, file);
        if (ferror(file))
            status =
                refuse_file(path, errno == EISDIR ? "is a directory, not a scene file" : strerror(errno));
        else if (length > SCENE_MAX_FILE_SIZE)
            status = refuse_file(path, "is larger than 16 MiB, not a scene file");
        else
            status = scene_read_text(path, text, length, scene);
    }
    free(text);
    fclose(file);
    return status;
}

void scene_destroy(struct scene *scene)
{
    for (size_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    for (size_t i = 0; i < scene->object_count; i++)
        free(scene->objects[i].name);
    free(scene->path);
    free(scene->materials);
    free(scene->objects);
    free(scene->lights);
    *scene = (struct scene){0};
}
