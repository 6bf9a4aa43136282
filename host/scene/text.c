#include "scene/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/schema.h"

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

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))
#define FIELDS(array) .fields = (array), .field_count = COUNT_OF(array)

enum { SCENE_CAMERA, SCENE_IMAGE, SCENE_MATERIALS, SCENE_OBJECTS, SCENE_LIGHTS };
static const struct field scene_fields[] = {
    {"camera", FIELD_NODE, true, 0, 0, NULL},
    {"image", FIELD_NODE, true, 0, 0, NULL},
    {"materials", FIELD_NODE, false, 0, 0, NULL},
    {"objects", FIELD_NODE, false, 0, 0, NULL},
    {"lights", FIELD_NODE, false, 0, 0, NULL},
    {"background", FIELD_VECTOR, false, 0, offsetof(struct scene, background), amount},
    {"max_bounces", FIELD_COUNT, false, 0, offsetof(struct scene, max_bounces), bounce_count},
    {"light_samples", FIELD_COUNT, false, 0, offsetof(struct scene, light_samples), sample_count},
};
static const struct schema scene_schema = {.label = "", FIELDS(scene_fields)};

enum { CAMERA_POSITION, CAMERA_LOOK_AT, CAMERA_UP };
static const struct field camera_fields[] = {
    {"position", FIELD_VECTOR, true, 0, offsetof(struct scene_camera, position), coordinate},
    {"look_at", FIELD_VECTOR, true, 0, offsetof(struct scene_camera, look_at), coordinate},
    {"up", FIELD_VECTOR, false, 0, offsetof(struct scene_camera, up), NULL},
    {"fov_y", FIELD_NUMBER, false, 0, offsetof(struct scene_camera, fov_y_degrees), field_of_view},
};
static const struct schema camera_schema = {.label = "camera", FIELDS(camera_fields)};

static const struct field image_fields[] = {
    {"width", FIELD_COUNT, true, 0, offsetof(struct scene, width), picture_side},
    {"height", FIELD_COUNT, true, 0, offsetof(struct scene, height), picture_side},
};
static const struct schema image_schema = {.label = "image", FIELDS(image_fields)};

static const char *const material_types[] = {"matte", "mirror", "transparent"};
static const char *const material_labels[] = {"matte material", "mirror material", "transparent material"};
enum { MATTE = 1 << MATERIAL_MATTE, TRANSPARENT = 1 << MATERIAL_TRANSPARENT };
static const struct field material_fields[] = {
    {"name", FIELD_NAME, true, 0, offsetof(struct scene_material, name), NULL},
    {"type", FIELD_TYPE, true, 0, 0, NULL},
    {"color", FIELD_VECTOR, true, MATTE, offsetof(struct scene_material, color), albedo},
    {"roughness", FIELD_NUMBER, false, MATTE, offsetof(struct scene_material, roughness), amount},
    {"ior", FIELD_NUMBER, false, TRANSPARENT, offsetof(struct scene_material, ior), refraction},
};
static const struct schema material_schema = {"material", material_types, material_labels,
                                              COUNT_OF(material_types), FIELDS(material_fields)};

static const char *const object_types[] = {"sphere", "plane"};
enum { SPHERE = 1 << OBJECT_SPHERE, PLANE = 1 << OBJECT_PLANE };
enum { OBJECT_NAME, OBJECT_MATERIAL = 2, OBJECT_NORMAL = 6 };
static const struct field object_fields[] = {
    {"name", FIELD_NAME, true, 0, offsetof(struct scene_object, name), NULL},
    {"type", FIELD_TYPE, true, 0, 0, NULL},
    {"material", FIELD_NODE, true, 0, 0, NULL},
    {"center", FIELD_VECTOR, true, SPHERE, offsetof(struct scene_object, sphere.center), coordinate},
    {"radius", FIELD_NUMBER, true, SPHERE, offsetof(struct scene_object, sphere.radius), positive_length},
    {"point", FIELD_VECTOR, true, PLANE, offsetof(struct scene_object, plane.point), coordinate},
    {"normal", FIELD_VECTOR, true, PLANE, offsetof(struct scene_object, plane.normal), NULL},
};
static const struct schema object_schema = {"object", object_types, object_types, COUNT_OF(object_types),
                                            FIELDS(object_fields)};

static const char *const light_types[] = {"point", "quad"};
static const char *const light_labels[] = {"point light", "quad light"};
enum { POINT = 1 << LIGHT_POINT, QUAD = 1 << LIGHT_QUAD };
enum { LIGHT_U = 5, LIGHT_V };
static const struct field light_fields[] = {
    {"type", FIELD_TYPE, true, 0, 0, NULL},
    {"color", FIELD_VECTOR, false, 0, offsetof(struct scene_light, color), amount},
    {"power", FIELD_NUMBER, true, 0, offsetof(struct scene_light, power), amount},
    {"position", FIELD_VECTOR, true, POINT, offsetof(struct scene_light, point.position), coordinate},
    {"corner", FIELD_VECTOR, true, QUAD, offsetof(struct scene_light, quad.corner), coordinate},
    {"u", FIELD_VECTOR, true, QUAD, offsetof(struct scene_light, quad.u), coordinate},
    {"v", FIELD_VECTOR, true, QUAD, offsetof(struct scene_light, quad.v), coordinate},
};
static const struct schema light_schema = {"light", light_types, light_labels, COUNT_OF(light_types),
                                           FIELDS(light_fields)};

/* A name in the file and what it names. */
struct named {
    const struct yaml_node *name;
    size_t index;
};

struct reading {
    struct diagnostics *report;
    struct scene *scene;
    struct named *material_names, *object_names; /* the good ones; sorted once all are read */
    size_t material_name_count, object_name_count;
};

static double largest_component(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

static bool is_zero(const double v[3])
{
    return largest_component(v) == 0;
}

/* a and b scaled first, so that no square overflows or underflows. */
static bool are_parallel(const double a[3], const double b[3])
{
    int exponent_a, exponent_b;
    frexp(largest_component(a), &exponent_a);
    frexp(largest_component(b), &exponent_b);
    double p[3], q[3];
    for (int i = 0; i < 3; i++) {
        p[i] = ldexp(a[i], -exponent_a);
        q[i] = ldexp(b[i], -exponent_b);
    }
    double cross[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    double cross_length = hypot(hypot(cross[0], cross[1]), cross[2]);
    double product = hypot(hypot(p[0], p[1]), p[2]) * hypot(hypot(q[0], q[1]), q[2]);
    return cross_length <= LEAST_SINE * product;
}

static void read_camera(struct reading *reading, const struct yaml_node *node)
{
    struct scene_camera *camera = &reading->scene->camera;
    struct mapping mapping;
    schema_read(reading->report, &camera_schema, node, camera, &mapping);
    if (mapping.good[CAMERA_UP] && is_zero(camera->up)) {
        report_error(reading->report, mapping.values[CAMERA_UP]->place, "camera: up must not be zero");
        mapping.good[CAMERA_UP] = false;
    }
    if (!mapping.good[CAMERA_POSITION] || !mapping.good[CAMERA_LOOK_AT])
        return;

    double view[3];
    for (int i = 0; i < 3; i++)
        view[i] = camera->look_at[i] - camera->position[i];
    const struct yaml_node *up = mapping.values[CAMERA_UP], *look_at = mapping.values[CAMERA_LOOK_AT];
    if (is_zero(view))
        report_error(reading->report, look_at->place, "camera: look_at must differ from position");
    else if (mapping.good[CAMERA_UP] && are_parallel(view, camera->up))
        report_error(reading->report, (up ? up : look_at)->place,
                     "camera: up must not be parallel to the view direction, is [%g, %g, %g]%s",
                     camera->up[0], camera->up[1], camera->up[2], up ? "" : " by default");
}

static void read_material(struct reading *reading, const struct yaml_node *node, size_t index)
{
    struct scene_material *material = &reading->scene->materials[index];
    struct mapping mapping;
    material->ior = 1.3;
    schema_read(reading->report, &material_schema, node, material, &mapping);
    material->type = mapping.type < 0 ? MATERIAL_MATTE : (enum material_type)mapping.type;
    if (material->name)
        reading->material_names[reading->material_name_count++] = (struct named){mapping.values[0], index};
}

static int compare_text(const struct yaml_node *a, const struct yaml_node *b)
{
    int order = memcmp(a->text, b->text, a->length < b->length ? a->length : b->length);
    return order ? order : (a->length > b->length) - (a->length < b->length);
}

static int compare_named(const void *a, const void *b)
{
    const struct named *first = a, *second = b;
    int order = compare_text(first->name, second->name);
    return order ? order : (first->index > second->index) - (first->index < second->index);
}

static int compare_name_only(const void *key, const void *element)
{
    const struct named *named = element;
    return compare_text(key, named->name);
}

/* Sorts the names and reports those given twice. */
static void check_names(struct reading *reading, const char *what, struct named *names, size_t count)
{
    if (count == 0)
        return;
    qsort(names, count, sizeof(names[0]), compare_named);
    size_t first = 0;
    for (size_t i = 1; i < count; i++) {
        if (compare_text(names[i].name, names[first].name) != 0) {
            first = i;
            continue;
        }
        char quote[REPORT_QUOTE_SIZE];
        report_error(reading->report, names[i].name->place, "%s name %s is used twice, first in line %d",
                     what, report_quote(names[i].name->text, names[i].name->length, quote),
                     names[first].name->place.line);
    }
}

static void find_material(struct reading *reading, const struct mapping *mapping, struct scene_object *object)
{
    const struct yaml_node *node = mapping->values[OBJECT_MATERIAL];
    if (!node || node->type == YAML_BROKEN)
        return;
    const struct named *named = NULL;
    if (node->type == YAML_SCALAR && reading->material_name_count > 0)
        named = bsearch(node, reading->material_names, reading->material_name_count, sizeof(*named),
                        compare_name_only);
    if (named) {
        object->material = named->index;
        return;
    }
    char found[REPORT_QUOTE_SIZE];
    report_error(reading->report, node->place, "%smaterial must be the name of a material, is %s",
                 mapping->label, schema_describe(node, found));
}

static void read_object(struct reading *reading, const struct yaml_node *node, size_t index)
{
    struct scene_object *object = &reading->scene->objects[index];
    struct mapping mapping;
    object->place = node->place;
    schema_read(reading->report, &object_schema, node, object, &mapping);
    object->type = mapping.type < 0 ? OBJECT_SPHERE : (enum object_type)mapping.type;
    if (object->name)
        reading->object_names[reading->object_name_count++] =
            (struct named){mapping.values[OBJECT_NAME], index};
    find_material(reading, &mapping, object);
    if (mapping.type == OBJECT_PLANE && mapping.good[OBJECT_NORMAL] && is_zero(object->plane.normal))
        report_error(reading->report, mapping.values[OBJECT_NORMAL]->place, "%snormal must not be zero",
                     mapping.label);
}

static void read_light(struct reading *reading, const struct yaml_node *node, size_t index)
{
    struct scene_light *light = &reading->scene->lights[index];
    struct mapping mapping;
    light->place = node->place;
    light->color[0] = light->color[1] = light->color[2] = 1;
    schema_read(reading->report, &light_schema, node, light, &mapping);
    light->type = mapping.type < 0 ? LIGHT_POINT : (enum light_type)mapping.type;
    if (mapping.type != LIGHT_QUAD)
        return;

    const double *edges[] = {light->quad.u, light->quad.v};
    bool good = true;
    for (size_t i = 0; i < 2; i++) {
        const size_t field = LIGHT_U + i;
        bool short_edge = mapping.good[field] && largest_component(edges[i]) < LEAST_LENGTH;
        if (short_edge)
            report_error(reading->report, mapping.values[field]->place, "%s%s must be at least 1e-15 long",
                         mapping.label, light_fields[field].name);
        good = good && mapping.good[field] && !short_edge;
    }
    if (good && are_parallel(edges[0], edges[1]))
        report_error(reading->report, mapping.values[LIGHT_V]->place, "%su and v must not be parallel",
                     mapping.label);
}

/* Counts the items of a list, which may be missing or empty, and makes room for them. */
static void *start_list(struct diagnostics *report, const char *name, const struct yaml_node *node,
                        size_t item_size, size_t *count)
{
    *count = 0;
    if (!node || node->type == YAML_BROKEN || yaml_is_empty(node))
        return NULL;
    if (node->type != YAML_SEQUENCE) {
        char found[REPORT_QUOTE_SIZE];
        report_error(report, node->place, "%s must be a list, is %s", name, schema_describe(node, found));
        return NULL;
    }
    if (node->count == 0)
        return NULL;
    void *items = calloc(node->count, item_size);
    if (items)
        *count = node->count;
    else
        report->no_memory = true;
    return items;
}

static void read_lists(struct reading *reading, const struct mapping *top)
{
    struct scene *scene = reading->scene;
    struct diagnostics *report = reading->report;
    const struct yaml_node *materials = top->values[SCENE_MATERIALS], *objects = top->values[SCENE_OBJECTS],
                           *lights = top->values[SCENE_LIGHTS];
    scene->materials =
        start_list(report, "materials", materials, sizeof(scene->materials[0]), &scene->material_count);
    scene->objects = start_list(report, "objects", objects, sizeof(scene->objects[0]), &scene->object_count);
    scene->lights = start_list(report, "lights", lights, sizeof(scene->lights[0]), &scene->light_count);
    reading->material_names = calloc(scene->material_count + 1, sizeof(struct named));
    reading->object_names = calloc(scene->object_count + 1, sizeof(struct named));
    if (!reading->material_names || !reading->object_names)
        report->no_memory = true;
    if (report->no_memory)
        return;

    const struct yaml_node *item = scene->material_count ? materials->child : NULL;
    for (size_t i = 0; item && !report->no_memory; item = item->next)
        read_material(reading, item, i++);
    check_names(reading, "material", reading->material_names, reading->material_name_count);

    item = scene->object_count ? objects->child : NULL;
    for (size_t i = 0; item && !report->no_memory; item = item->next)
        read_object(reading, item, i++);
    check_names(reading, "object", reading->object_names, reading->object_name_count);

    item = scene->light_count ? lights->child : NULL;
    for (size_t i = 0; item && !report->no_memory; item = item->next)
        read_light(reading, item, i++);
}

static void read_root(struct diagnostics *report, const struct yaml_node *root, struct scene *scene)
{
    struct reading reading = {.report = report, .scene = scene};
    struct mapping top;
    schema_read(report, &scene_schema, root, scene, &top);
    if (top.values[SCENE_CAMERA])
        read_camera(&reading, top.values[SCENE_CAMERA]);
    struct mapping image;
    if (top.values[SCENE_IMAGE])
        schema_read(report, &image_schema, top.values[SCENE_IMAGE], scene, &image);
    read_lists(&reading, &top);
    free(reading.material_names);
    free(reading.object_names);
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
    struct yaml_tree tree;
    yaml_parse(&report, &tree);
    if (tree.root)
        read_root(&report, tree.root, scene);
    else if (report.count == 0)
        report_error(&report, (struct scene_place){1, 1},
                     "the file is empty; a scene needs \"camera\" and "
                     "\"image\"");
    yaml_free(&tree);

    enum status status = report.no_memory ? STATUS_UNABLE : report.count > 0 ? STATUS_REFUSED : STATUS_DONE;
    report_print(&report);
    if (report.no_memory)
        log_error("no memory to read the scene file %s", path);
    report_clear(&report);
    if (status != STATUS_DONE)
        scene_destroy(scene);
    return status;
}
