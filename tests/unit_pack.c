/* The packed scene: what is settled once for device and reference. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>

#include "scene/scene.h"
#include "scene/vector.h"
#include "test_folder.h"
#include "test_render.h"

#define HEAD TEST_SCENE_HEAD

static enum status try_pack(const char *text, struct packed_scene *packed)
{
    struct scene scene;
    assert_int_equal(scene_read_text("test.yaml", text, strlen(text), &scene), STATUS_DONE);
    struct picture_settings settings = test_settings(&scene);
    enum status status = pack_scene(NULL, &scene, &settings, packed);
    scene_destroy(&scene);
    return status;
}

static struct packed_scene pack(const char *objects_and_lights)
{
    struct packed_scene packed;
    char text[4096];
    snprintf(text, sizeof text, "%s%s", HEAD, objects_and_lights);
    assert_int_equal(try_pack(text, &packed), STATUS_DONE);
    return packed;
}

static void scale_lengths(double vector[3], double factor)
{
    for (int i = 0; i < 3; ++i)
        vector[i] *= factor;
}

static void scale_scene(struct scene *scene, double factor)
{
    scale_lengths(scene->camera.position, factor);
    scale_lengths(scene->camera.look_at, factor);
    for (size_t i = 0; i < scene->object_count; ++i) {
        struct scene_object *object = &scene->objects[i];
        if (object->type == OBJECT_PLANE) {
            scale_lengths(object->plane.point, factor);
        } else {
            scale_lengths(object->sphere.center, factor);
            object->sphere.radius *= factor;
        }
    }
    for (size_t i = 0; i < scene->light_count; ++i) {
        struct scene_light *light = &scene->lights[i];
        if (light->type == LIGHT_POINT) {
            scale_lengths(light->point.position, factor);
            light->power *= factor * factor; /* radiance toward a point light falls as 1 / d^2 */
        } else {
            scale_lengths(light->quad.corner, factor);
            scale_lengths(light->quad.u, factor);
            scale_lengths(light->quad.v, factor);
        }
    }
}

static void check_same(const struct packed_scene *a, const struct packed_scene *b)
{
    assert_int_equal(a->sphere_count, b->sphere_count);
    assert_int_equal(a->plane_count, b->plane_count);
    assert_int_equal(a->giants, b->giants);
    assert_int_equal(a->surface_count, b->surface_count);
    assert_memory_equal(a->surfaces, b->surfaces, (size_t)a->surface_count * sizeof *a->surfaces);
    assert_int_equal(a->point_light_count, b->point_light_count);
    assert_int_equal(a->quad_light_count, b->quad_light_count);
    assert_memory_equal(&a->view, &b->view, sizeof a->view);
    assert_memory_equal(a->spheres, b->spheres, (size_t)a->sphere_count * sizeof *a->spheres);
    assert_memory_equal(a->planes, b->planes, (size_t)a->plane_count * sizeof *a->planes);
    assert_memory_equal(a->point_lights, b->point_lights,
                        (size_t)a->point_light_count * sizeof *a->point_lights);
    assert_memory_equal(a->quad_lights, b->quad_lights, (size_t)a->quad_light_count * sizeof *a->quad_lights);
}

static void scaling_by_powers_of_two(void **state)
{
    static const char *const names[] = {"scenes/figure_2b.yaml",         "scenes/figure_4.yaml",
                                        "tests/scenes/ten_lights.yaml",  "tests/scenes/oblique_planes.yaml",
                                        "tests/scenes/under_glass.yaml", "tests/scenes/ties.yaml",
                                        "scenes/hard/lake.yaml",         "tests/scenes/earth.yaml"};
    static const int exponents[] = {1, -1, 20, -20};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        for (size_t k = 0; k < sizeof exponents / sizeof *exponents; ++k) {
            struct packed_scene packed, scaled;
            struct scene scene = test_read(names[i]);
            struct picture_settings settings = test_settings(&scene);
            packed = test_pack(&scene, settings);
            scale_scene(&scene, ldexp(1, exponents[k]));
            scaled = test_pack(&scene, settings);
            check_same(&packed, &scaled);
            scene_destroy(&scene);
            pack_destroy(&packed);
            pack_destroy(&scaled);
        }
}

static float camera_height(const struct packed_scene *packed, int plane)
{
    layout_vec4 n = packed->planes[plane].normal_offset, eye = packed->view.position;
    return n.x * eye.x + n.y * eye.y + n.z * eye.z - n.w;
}

/* Opaque planes face the camera whichever way the file has them, transparent ones stay. */
static void planes_face_the_camera(void **state)
{
    (void)state;
    struct packed_scene packed =
        pack("objects:\n"
             "  - { name: A, type: plane, point: [0, -3, 0], normal: [0, -4, 0], material: Matte }\n"
             "  - { name: B, type: plane, point: [0, 7, 0], normal: [0, 1, 0.5], material: Mirror }\n"
             "  - { name: C, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Matte }\n"
             "  - { name: D, type: plane, point: [0, 0, 6], normal: [0, 0, 1], material: Glass }\n"
             "lights: []\n");
    assert_int_equal(packed.plane_count, 4);
    for (int i = 0; i < 3; ++i)
        assert_true(camera_height(&packed, i) > 0);
    assert_true(camera_height(&packed, 3) < 0);
    assert_true(packed.planes[0].normal_offset.y == 1);
    assert_true(packed.planes[3].normal_offset.z == 1);
    pack_destroy(&packed);
}

/* What coincides with an opaque object before it is never met; behind glass it may be. */
static void coincident_objects(void **state)
{
    (void)state;
    struct packed_scene packed =
        pack("objects:\n"
             "  - { name: A, type: plane, point: [0, -3, 0], normal: [0, 1, 0], material: Matte }\n"
             "  - { name: B, type: plane, point: [9, -3, 9], normal: [0, -2, 0], material: Mirror }\n"
             "  - { name: C, type: sphere, center: [0, 0, 4], radius: 1, material: Mirror }\n"
             "  - { name: D, type: sphere, center: [0, 0, 4], radius: 1, material: Matte }\n"
             "  - { name: E, type: sphere, center: [3, 0, 4], radius: 1, material: Glass }\n"
             "  - { name: F, type: sphere, center: [3, 0, 4], radius: 1, material: Matte }\n"
             "lights: []\n");
    assert_int_equal(packed.plane_count, 1);
    assert_int_equal(packed.planes[0].surface.tags.FILE_ORDER, 0);
    assert_int_equal(packed.sphere_count, 3);
    assert_int_equal(packed.spheres[0].tags.FILE_ORDER, 2);
    assert_int_equal(packed.spheres[1].tags.FILE_ORDER, 4);
    assert_int_equal(packed.spheres[2].tags.FILE_ORDER, 5);
    pack_destroy(&packed);
}

/* The camera cannot see what a light behind an opaque plane lights; a quad light may stick out. */
static void lights_behind_planes(void **state)
{
    (void)state;
    struct packed_scene packed =
        pack("objects:\n"
             "  - { name: A, type: plane, point: [0, -3, 0], normal: [0, 1, 0], material: Matte }\n"
             "  - { name: B, type: plane, point: [0, 0, 9], normal: [0, 0, 1], material: Glass }\n"
             "  - { name: C, type: plane, point: [0, 9, 0], normal: [0, 1, 0], material: Matte }\n"
             "lights:\n"
             "  - { type: point, position: [0, -4, 0], color: [1, 1, 1], power: 1 }\n"
             "  - { type: point, position: [0, -3, 0], color: [1, 1, 1], power: 2 }\n"
             "  - { type: point, position: [0, 4, 8], color: [1, 1, 1], power: 4 }\n"
             "  - { type: quad, corner: [0, 8, 0], u: [0, 2, 0], v: [1, 0, 0], power: 1 }\n");
    assert_int_equal(packed.point_light_count, 2);
    assert_true(packed.point_lights[0].intensity.x * 2 == packed.point_lights[1].intensity.x);
    assert_int_equal(packed.quad_light_count, 1);
    assert_int_equal(packed.planes[0].surface.tags.CASTS_SHADOWS, 0);
    assert_int_equal(packed.planes[1].surface.tags.CASTS_SHADOWS, 1); /* glass can always stand between */
    assert_int_equal(packed.planes[2].surface.tags.CASTS_SHADOWS, 1);
    pack_destroy(&packed);
}

/* Whatever else the scene holds a thousand kilometres away, 0.4 m behind a wall is behind it. */
static void lights_behind_planes_of_large_scenes(void **state)
{
    (void)state;
    struct packed_scene packed =
        pack("objects:\n"
             "  - { name: A, type: sphere, center: [0, -1000000, 0], radius: 1000000, material: Matte }\n"
             "  - { name: B, type: plane, point: [0, 0, 3], normal: [0, 0, -1], material: Matte }\n"
             "lights:\n"
             "  - { type: point, position: [0, 3, 3.4], color: [1, 1, 1], power: 1 }\n"
             "  - { type: quad, corner: [-1, 3, 3.4], u: [2, 0, 0], v: [0, 2, 0], power: 5 }\n");
    assert_int_equal(packed.point_light_count, 0);
    assert_int_equal(packed.planes[0].surface.tags.CASTS_SHADOWS, 1);
    pack_destroy(&packed);
}

/* Tags z (rays or points may be inside) and w (lights may be). */
static void hollow_spheres(void **state)
{
    (void)state;
    struct packed_scene packed =
        pack("objects:\n"
             "  - { name: Plain, type: sphere, center: [0, 0, 4], radius: 1, material: Matte }\n"
             "  - { name: Camera, type: sphere, center: [0, 2, -6.5], radius: 1, material: Mirror }\n"
             "  - { name: Empty, type: sphere, center: [4, 0, 4], radius: 1, material: Glass }\n"
             "  - { name: Holder, type: sphere, center: [8, 0, 4], radius: 1, material: Glass }\n"
             "  - { name: Held, type: sphere, center: [8.5, 0, 4], radius: 0.25, material: Matte }\n"
             "  - { name: Lamp, type: sphere, center: [-4, 0, 4], radius: 1, material: Matte }\n"
             "  - { name: Spiked, type: sphere, center: [-8, 0, 4], radius: 1, material: Matte }\n"
             "  - { name: Stands, type: sphere, center: [12, -3, 4], radius: 1, material: Glass }\n"
             "  - { name: Touches, type: sphere, center: [16, -2, 4], radius: 1, material: Glass }\n"
             "  - { name: Ground, type: plane, point: [0, -3, 0], normal: [0, 1, 0], material: Matte }\n"
             "lights:\n"
             "  - { type: point, position: [-4, 0.5, 4], color: [1, 1, 1], power: 1 }\n"
             "  - { type: quad, corner: [-8, 0, 4], u: [0, 3, 0], v: [0, 0, 1], power: 1 }\n");
    static const struct {
        int rays, lights;
    } expected[] = {{0, 0}, {1, 0}, {0, 0}, {1, 0}, {0, 0}, {0, 1}, {0, 1}, {1, 0}, {0, 0}};
    assert_int_equal(packed.sphere_count, sizeof expected / sizeof *expected);
    for (int i = 0; i < packed.sphere_count; ++i) {
        assert_int_equal(packed.spheres[i].tags.HOLDS_RAYS != 0, expected[i].rays);
        assert_int_equal(packed.spheres[i].tags.HOLDS_LIGHTS, expected[i].lights);
    }
    pack_destroy(&packed);
}

static struct packed_scene pack_ball(struct dvec3 center, double radius)
{
    char text[256];
    snprintf(text, sizeof text,
             "objects: [{ name: A, type: sphere, center: [%.17g, %.17g, %.17g], radius: %.17g, material: "
             "Glass }]\n"
             "lights: []\n",
             center.x, center.y, center.z, radius);
    return pack(text);
}

static bool is_giant_below(double depth, double radius)
{
    struct packed_scene packed = pack_ball((struct dvec3){0, -depth - radius, 0}, radius);
    bool giant = packed.giants == 1;
    assert_true(giant ? packed.view.position.z == -0.75F : fabsf(packed.view.position.z) < 0.125F);
    pack_destroy(&packed);
    return giant;
}

/* The camera has coordinates up to 6 and is at 2 and more over the surface; the scene's extent is the
 * camera's where the ball is a giant. */
static void choice_of_giants(void **state)
{
    (void)state;
    assert_false(is_giant_below(0, 47.9));
    assert_true(is_giant_below(0, 48.1));
    assert_true(is_giant_below(0, 1e14));
    assert_false(is_giant_below(6, 64));
    assert_true(is_giant_below(6, 70));
}

/* Whether the height of the point over the packed giant, in metres, is that over the ball, but for the
 * rounding of gradient, offset and curvature to float, and for what doubles know of the ball. */
static bool is_near(const struct packed_scene *packed, struct dvec3 center, double radius, struct dvec3 point)
{
    const double scale = (double)packed->view.position.z / -6, half_ulp = 0x1p-24;
    const layout_vec4 shape = packed->spheres[0].center_radius;
    const double curvature = (double)packed->surfaces[0].more_parameters.CURVATURE;
    const struct dvec3 scaled = dvec3_scale(scale, point), gradient = dvec3_of_vec4(shape);
    const double linear = dvec3_dot(gradient, scaled), bend = curvature / 2 * dvec3_dot(scaled, scaled);
    const double height = (linear + bend - (double)shape.w) / scale;
    const double distance = dvec3_distance(point, center) - radius;
    const double rounding = (fabs(gradient.x * scaled.x) + fabs(gradient.y * scaled.y) +
                             fabs(gradient.z * scaled.z) + bend + fabs((double)shape.w)) /
                            scale * half_ulp;
    return fabs(height - distance * (1 + distance / (2 * radius))) <= rounding + 4 * 0x1p-53 * radius;
}

static void packed_giants_are_where_they_are(void **state)
{
    (void)state;
    srand48(1);
    for (int i = 0; i < 1000; ++i) {
        const struct dvec3 way = {drand48() - 0.5, i % 4 ? drand48() - 0.5 : 0, i % 4 ? drand48() - 0.5 : 0};
        const double radius = pow(10, 2 + 6 * drand48()), height = 6 * drand48() - 3;
        const struct dvec3 center = dvec3_scale(height - radius, dvec3_unit(way));
        struct packed_scene packed = pack_ball(center, radius);
        assert_int_equal(packed.giants, 1);
        for (int k = 0; k < 10; ++k)
            assert_true(is_near(&packed, center, radius,
                                (struct dvec3){10 * drand48() - 5, 10 * drand48() - 5, 10 * drand48() - 5}));
        pack_destroy(&packed);
    }
}

static void check_message(const char *objects_and_lights, enum status expected, int lines,
                          const char *beginning)
{
    struct packed_scene packed;
    char text[4096], line[256];
    snprintf(text, sizeof text, "%s%s", HEAD, objects_and_lights);
    test_messages_begin();
    enum status status = try_pack(text, &packed);
    int printed = test_messages_end(line);
    assert_int_equal(status, expected);
    assert_int_equal(printed, lines);
    line[strlen(beginning) < sizeof line ? strlen(beginning) : sizeof line - 1] = '\0';
    assert_string_equal(line, beginning);
    pack_destroy(&packed);
}

/* The least that a double holds is a direction too. */
static void directions_of_any_length(void **state)
{
    (void)state;
    struct scene scene = test_read("scenes/figure_2b.yaml");
    struct picture_settings settings = test_settings(&scene);
    struct packed_scene usual, packed;
    usual = test_pack(&scene, settings);
    scale_lengths(scene.camera.up, 0x1p-1074);
    for (size_t i = 0; i < scene.object_count; ++i)
        if (scene.objects[i].type == OBJECT_PLANE)
            scale_lengths(scene.objects[i].plane.normal, 0x1p-1074);
    packed = test_pack(&scene, settings);
    check_same(&usual, &packed);
    scene_destroy(&scene);
    pack_destroy(&usual);
    pack_destroy(&packed);
}

static void lights_too_bright(void **state)
{
    (void)state;
    check_message("objects: []\nlights:\n"
                  "  - { type: point, position: [0, 5, 0], color: [1, 1, 1], power: 1e15 }\n",
                  STATUS_REFUSED, 1, "vkwhitted: error: test.yaml:9:5: point light: ");
    check_message("objects: []\nlights:\n"
                  "  - { type: quad, corner: [0, 5, 0], u: [1, 0, 0], v: [0, 0, 1], power: 1e13 }\n",
                  STATUS_REFUSED, 1, "vkwhitted: error: test.yaml:9:5: quad light: ");
    check_message("objects: []\nlights:\n"
                  "  - { type: quad, corner: [0, 5, 0], u: [1, 0, 0], v: [0, 0, 1], power: 1e11 }\n",
                  STATUS_DONE, 0, "");
}

static void spheres_too_small(void **state)
{
    (void)state;
    check_message(
        "objects:\n  - { name: S, type: sphere, center: [0, 0, 0], radius: 1e-15, material: Matte }\n",
        STATUS_REFUSED, 1, "vkwhitted: error: test.yaml:8:5: sphere \"S\": radius must be at least ");
    check_message(
        "objects:\n  - { name: S, type: sphere, center: [0, 0, 0], radius: 1e-14, material: Matte }\n",
        STATUS_DONE, 0, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scaling_by_powers_of_two),
        cmocka_unit_test(planes_face_the_camera),
        cmocka_unit_test(coincident_objects),
        cmocka_unit_test(lights_behind_planes),
        cmocka_unit_test(hollow_spheres),
        cmocka_unit_test(lights_too_bright),
        cmocka_unit_test(spheres_too_small),
        cmocka_unit_test(choice_of_giants),
        cmocka_unit_test(packed_giants_are_where_they_are),
        cmocka_unit_test(directions_of_any_length),
        cmocka_unit_test(lights_behind_planes_of_large_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
