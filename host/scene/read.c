#include <errno.h>
#include <math.h>
#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "scene/scene.h"
#include "scene/schema.h"
#include "scene/spheres_file.h"
#include "scene/vector.h"

/* Lengths far from the ends of float's range leave room for squares: 1e15 squared is 1e30. */
#define MOST 1e15
#define LEAST_LENGTH 1e-15

/* Sine of the angle under which two directions count as parallel: some 10 units in float's last place. */
#define LEAST_SINE 1e-6

static const struct bounds coordinate = {-MOST, MOST, "within -1e15..1e15", false};
static const struct bounds positive_length = {LEAST_LENGTH, MOST, "within 1e-15..1e15", true};
static const struct bounds field_of_view = {/* just above 0, just below 180 */ 0x1p-1074, 180 - 0x1p-45,
                                            "> 0 and < 180 degrees", false};
static const struct bounds refraction = {1e-3, 1e3, "within 0.001..1000", true};
static const struct bounds albedo = {0, 1, "within 0..1", false};
static const struct bounds amount = {0, MOST, "within 0..1e15", false};
static const struct bounds picture_side = {1, SCENE_MAX_SIZE, "", false};
static const struct bounds bounce_count = {0, SCENE_MAX_BOUNCES, "", false};
static const struct bounds sample_count = {1, SCENE_MAX_SAMPLES, "", false};

static const struct field scene_fields[MAX_FIELDS] = {
    {"camera", NULL, true, 0, 0, NULL},
    {"image", NULL, true, 0, 0, NULL},
    {"materials", NULL, false, 0, 0, NULL},
    {"objects", NULL, false, 0, 0, NULL},
    {"lights", NULL, false, 0, 0, NULL},
    {"background", read_vector, false, 0, offsetof(struct scene, background), &amount},
    {"max_bounces", read_count, false, 0, offsetof(struct scene, max_bounces), &bounce_count},
    {"light_samples", read_count, false, 0, offsetof(struct scene, light_samples), &sample_count},
};
static const struct schema scene_schema = {.label = "", .fields = scene_fields};

static const struct field camera_fields[MAX_FIELDS] = {
    {"position", read_vector, true, 0, offsetof(struct scene_camera, position), &coordinate},
    {"look_at", read_vector, true, 0, offsetof(struct scene_camera, look_at), &coordinate},
    {"up", read_vector, false, 0, offsetof(struct scene_camera, up), NULL},
    {"fov_y", read_number, false, 0, offsetof(struct scene_camera, fov_y_degrees), &field_of_view},
};
static const struct schema camera_schema = {.label = "camera", .fields = camera_fields};

static const struct field image_fields[MAX_FIELDS] = {
    {"width", read_count, true, 0, offsetof(struct scene, width), &picture_side},
    {"height", read_count, true, 0, offsetof(struct scene, height), &picture_side},
};
static const struct schema image_schema = {.label = "image", .fields = image_fields};

enum { MATTE = 1 << MATERIAL_MATTE, TRANSPARENT = 1 << MATERIAL_TRANSPARENT };
static const struct field material_fields[MAX_FIELDS] = {
    {"name", read_name, true, 0, offsetof(struct scene_material, name), NULL},
    {"type", read_type, true, 0, offsetof(struct scene_material, type), NULL},
    {"color", read_vector, true, MATTE, offsetof(struct scene_material, color), &albedo},
    {"roughness", read_number, false, MATTE, offsetof(struct scene_material, roughness), &amount},
    {"ior", read_number, false, TRANSPARENT, offsetof(struct scene_material, ior), &refraction},
};
static const struct schema material_schema = {
    .label = "material", .types = {"matte", "mirror", "transparent"}, .fields = material_fields};

enum { SPHERE = 1 << OBJECT_SPHERE, PLANE = 1 << OBJECT_PLANE, SPHERES = 1 << OBJECT_SPHERES };
static const struct field object_fields[MAX_FIELDS] = {
    {"name", read_name, true, 0, offsetof(struct scene_object, name), NULL},
    {"type", read_type, true, 0, offsetof(struct scene_object, type), NULL},
    {"material", NULL, true, 0, 0, NULL},
    {"center", read_vector, true, SPHERE, offsetof(struct scene_object, sphere.center), &coordinate},
    {"radius", read_number, true, SPHERE, offsetof(struct scene_object, sphere.radius), &positive_length},
    {"point", read_vector, true, PLANE, offsetof(struct scene_object, plane.point), &coordinate},
    {"normal", read_vector, true, PLANE, offsetof(struct scene_object, plane.normal), NULL},
    {"file", NULL, true, SPHERES, 0, NULL},
};
static const struct schema object_schema = {
    .label = "object", .type_alone = true, .types = {"sphere", "plane", "spheres"}, .fields = object_fields};
static const struct npy_column row_columns[NPY_COLUMNS] = {
    {"x", &coordinate}, {"y", &coordinate}, {"z", &coordinate}, {"radius", &positive_length}};

enum { POINT = 1 << LIGHT_POINT, QUAD = 1 << LIGHT_QUAD };
static const struct field light_fields[MAX_FIELDS] = {
    {"type", read_type, true, 0, offsetof(struct scene_light, type), NULL},
    {"color", read_vector, false, 0, offsetof(struct scene_light, color), &amount},
    {"power", read_number, true, 0, offsetof(struct scene_light, power), &amount},
    {"position", read_vector, true, POINT, offsetof(struct scene_light, point.position), &coordinate},
    {"corner", read_vector, true, QUAD, offsetof(struct scene_light, quad.corner), &coordinate},
    {"u", read_vector, true, QUAD, offsetof(struct scene_light, quad.u), &coordinate},
    {"v", read_vector, true, QUAD, offsetof(struct scene_light, quad.v), &coordinate},
};
static const struct schema light_schema = {
    .label = "light", .types = {"point", "quad"}, .fields = light_fields};

/* A material or object by its name; names point into the scene. */
struct named {
    const char *name;
    int line;
    const void *item;
};

struct reading {
    struct diagnostics *report;
    struct scene *scene;
    struct mapping top;
    void *material_names, *object_names; /* of struct named, for tsearch() */
    size_t sphere_count;
};

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

/* Adds the name of a mapping, if it has a good one, to those before it; refuses one that is among them. */
static void add_name(struct mapping *mapping, const char *name, const void *item, void **names)
{
    if (!name)
        return;
    struct scene_place place = yaml_place(mapping->report, schema_find(mapping, "name").written);
    struct named *named = malloc(sizeof *named), **found = NULL;
    if (named) {
        *named = (struct named){name, place.line, item};
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

static void read_camera(struct diagnostics *report, const struct yaml_value *value,
                        struct scene_camera *camera)
{
    struct mapping mapping;
    schema_read(report, &camera_schema, value, camera, &mapping);
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

static void read_material(struct reading *reading, const struct yaml_value *value, void *item)
{
    struct scene_material *material = item;
    struct mapping mapping;
    material->ior = 1.3;
    schema_read(reading->report, &material_schema, value, material, &mapping);
    add_name(&mapping, material->name, item, &reading->material_names);
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
        object->material =
            (size_t)((const struct scene_material *)(*found)->item - reading->scene->materials);
    else
        schema_expect(mapping, &value, "material", "the name of a material");
}

static void count_bodies(struct reading *reading, struct mapping *mapping, struct scene_object *object)
{
    const size_t count = object->type == OBJECT_SPHERES ? object->spheres.count : 1;
    object->first = reading->scene->body_count;
    reading->scene->body_count += count;
    if (object->type == OBJECT_PLANE)
        return;
    if (reading->sphere_count + count > SCENE_MAX_SPHERES)
        schema_refuse(mapping, mapping->value.written, "is one sphere too many: a scene may have %d",
                      SCENE_MAX_SPHERES);
    else
        reading->sphere_count += count;
}

static void read_object(struct reading *reading, const struct yaml_value *value, void *item)
{
    struct scene_object *object = item;
    struct mapping mapping;
    schema_read(reading->report, &object_schema, value, object, &mapping);
    add_name(&mapping, object->name, item, &reading->object_names);
    find_material(reading, &mapping, object);
    object->place = yaml_place(reading->report, value->written);
    if (mapping.type == OBJECT_SPHERES)
        spheres_file_read(&mapping, row_columns, SCENE_MAX_SPHERES - reading->sphere_count, object);
    count_bodies(reading, &mapping, object);
    if (mapping.good && object->type == OBJECT_PLANE && dvec3_largest(dvec3_of(object->plane.normal)) == 0)
        schema_refuse(&mapping, schema_find(&mapping, "normal").written, "normal must not be zero");
}

static void read_light(struct reading *reading, const struct yaml_value *value, void *item)
{
    struct scene_light *light = item;
    struct mapping mapping;
    light->color[0] = light->color[1] = light->color[2] = 1;
    schema_read(reading->report, &light_schema, value, light, &mapping);
    light->place = yaml_place(reading->report, value->written);
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

/* Reads the list behind a key of the scene file, which may be missing or empty; the first item, allocated, or
 * NULL. */
static void *read_list(struct reading *reading, const char *name, size_t item_size,
                       void (*read_item)(struct reading *, const struct yaml_value *, void *), size_t *count)
{
    const struct yaml_value value = schema_find(&reading->top, name);
    if (!value.written || (value.plain && value.length == 0))
        return NULL;
    if (value.type != FYNT_SEQUENCE)
        schema_expect(&reading->top, &value, name, "a list");
    int items = fy_node_sequence_item_count(value.node);
    char *list = items > 0 ? calloc((size_t)items, item_size) : NULL;
    reading->report->no_memory |= items > 0 && !list;
    void *at = NULL;
    for (*count = 0;
         list && *count < (size_t)items && !reading->report->no_memory && !reading->report->unable;
         ++*count) {
        const struct yaml_value item =
            yaml_read(reading->report, fy_node_sequence_iterate(value.node, &at), value.written);
        read_item(reading, &item, list + *count * item_size);
    }
    return list;
}

static void read_root(struct diagnostics *report, const struct yaml_value *root, struct scene *scene)
{
    struct reading reading = {.report = report, .scene = scene};
    schema_read(report, &scene_schema, root, scene, &reading.top);
    const struct yaml_value camera = schema_find(&reading.top, "camera");
    const struct yaml_value image = schema_find(&reading.top, "image");
    struct mapping mapping;
    if (camera.written)
        read_camera(report, &camera, &scene->camera);
    if (image.written)
        schema_read(report, &image_schema, &image, scene, &mapping);
    scene->materials =
        read_list(&reading, "materials", sizeof *scene->materials, read_material, &scene->material_count);
    scene->objects =
        read_list(&reading, "objects", sizeof *scene->objects, read_object, &scene->object_count);
    scene->lights = read_list(&reading, "lights", sizeof *scene->lights, read_light, &scene->light_count);
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
    if (document) {
        const struct yaml_value root = yaml_read(&report, fy_document_root(document), NULL);
        read_root(&report, &root, scene);
    } else if (report.count == 0 && !report.no_memory) {
        report_error(&report, (struct scene_place){1, 1},
                     "the file is empty; a scene needs \"camera\" and \"image\"");
    }
    fy_document_destroy(document);

    enum status status = report.no_memory || report.unable ? STATUS_UNABLE
                         : report.count > 0                ? STATUS_REFUSED
                                                           : STATUS_DONE;
    report_print(&report);
    if (report.no_memory)
        log_error("no memory to read the scene file %s", path);
    if (status != STATUS_DONE)
        scene_destroy(scene);
    return status;
}

enum status scene_refuse_file(const char *path, int error)
{
    report_line("%s: error: %s", path,
                error == EFBIG ? "is larger than 16 MiB, not a scene file" : input_file_problem(error));
    return input_file_status(error);
}

enum status scene_read(const char *path, struct scene *scene)
{
    *scene = (struct scene){0};
    size_t length;
    char *text = text_file_read(path, false, SCENE_MAX_FILE_SIZE, &length);
    if (text) {
        enum status status = scene_read_text(path, text, length, scene);
        free(text);
        return status;
    }
    return scene_refuse_file(path, errno);
}

void scene_destroy(struct scene *scene)
{
    for (size_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    for (size_t i = 0; i < scene->object_count; i++) {
        free(scene->objects[i].name);
        if (scene->objects[i].type == OBJECT_SPHERES)
            free(scene->objects[i].spheres.rows);
    }
    free(scene->path);
    free(scene->materials);
    free(scene->objects);
    free(scene->lights);
    *scene = (struct scene){0};
}
