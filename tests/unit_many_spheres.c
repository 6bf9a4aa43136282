/* Spheres that are not looped over: with the tree that the host builds for it, the reference makes the
 * picture that it makes by trying all of them, and tells the same of each pixel. */
#include "cmocka_test.h"

#include <stdio.h>
#include <stdlib.h>

#include "failing_memory.h"
#include "pixel/ray_tree.h"
#include "scene/hierarchy.h"
#include "test_render.h"
#include "tracer/reference_scene.h"

enum { WIDTH = 36, HEIGHT = 24, PIXELS = WIDTH * HEIGHT, CLOUD = 1500 };

static void build_hierarchy(struct packed_scene *packed)
{
    packed->looped_spheres = 0;
    packed->hierarchy = calloc(1, sizeof *packed->hierarchy);
    assert_int_equal(hierarchy_build(packed->spheres, 0, (uint32_t)packed->sphere_count, packed->hierarchy),
                     STATUS_DONE);
    packed->hierarchy->owners = 1;
}

static struct packed_scene pack(const struct scene *scene)
{
    struct picture_settings settings = test_settings(scene);
    settings.width = WIDTH;
    settings.height = HEIGHT;
    settings.light_samples = 2;
    return test_pack(scene, settings);
}

static struct render_plan plan_of(const struct packed_scene *packed)
{
    return (struct render_plan){.scene = packed, .window = {0, 0, WIDTH, HEIGHT}, .quiet = true};
}

static void check_picture(const char *name, const struct packed_scene *packed)
{
    uint32_t *signatures;
    struct render_plan plan = plan_of(packed);
    struct rendering rendering;
    struct reference_rays rays = {0};
    assert_int_equal(signatures_on_cpu(&plan, &signatures), STATUS_DONE);
    plan.precision = PRECISION_DOUBLE;
    assert_int_equal(render_on_cpu(&plan, &rendering), STATUS_DONE);
    for (int i = 0; i < PIXELS; ++i) {
        const int x = i % WIDTH, y = i / WIDTH;
        const struct reference_pixel expected = reference_trace_double(packed, x, y, NULL);
        if (memcmp(rendering.image.rgb64 + 3 * i, expected.rgb, sizeof expected.rgb) != 0 ||
            signatures[i] != reference_trace_float(packed, x, y, NULL).signature)
            fail_msg("%s: the tree makes another picture", name);
        rays_add(&rays, expected.rays);
    }
    assert_memory_equal(&rendering.rays, &rays, sizeof rays);
    free(signatures);
    image_destroy(&rendering.image);
}

/* Where a margin is at least 1, it may be larger with the tree. */
static void check_explanations(const char *name, const struct packed_scene *packed)
{
    struct reference_explanation *explanations;
    struct render_plan plan = plan_of(packed);
    assert_int_equal(explain_on_cpu(&plan, PRECISION_DOUBLE, &explanations), STATUS_DONE);
    for (int i = 0; i < PIXELS; ++i) {
        const struct reference_explanation expected =
            reference_explain_double(packed, i % WIDTH, i / WIDTH, NULL);
        if (expected.margin >= 1 && explanations[i].margin >= expected.margin)
            explanations[i].margin = expected.margin;
        if (memcmp(&explanations[i], &expected, sizeof expected) != 0)
            fail_msg("%s, pixel %d: margin %.9g, not %.9g, or more is different", name, i,
                     explanations[i].margin, expected.margin);
    }
    free(explanations);
}

static void check_events(const char *name, const struct packed_scene *packed)
{
    static struct reference_event events[1 << 16];
    for (int i = 0; i < PIXELS; i += 31) {
        struct render_plan plan = plan_of(packed);
        struct reference_log log = {.events = events, .room = sizeof events / sizeof *events};
        struct ray_tree tree;
        plan.window = (struct window){(unsigned)(i % WIDTH), (unsigned)(i / WIDTH), 1, 1};
        reference_trace_float(packed, i % WIDTH, i / WIDTH, &log);
        assert_int_equal(ray_tree_on_cpu(&plan, PRECISION_FLOAT, &tree), STATUS_DONE);
        assert_int_equal(tree.count + tree.beyond, log.count);
        size_t kept = log.count < log.room ? log.count : log.room;
        if (memcmp(tree.events, events, kept * sizeof *events) != 0)
            fail_msg("%s, pixel %d: other events", name, i);
        ray_tree_destroy(&tree);
    }
}

static float random_number(uint32_t *state)
{
    *state = *state * UINT32_C(1664525) + UINT32_C(1013904223);
    return (float)(*state >> 8) * 0x1p-24f;
}

/* Puts many spheres around the scene's first, of the surfaces of its spheres, which may lie in each other. */
static void make_cloud(struct packed_scene *packed)
{
    const layout_vec4 middle = packed->spheres[0].center_radius;
    uint32_t random = 7;
    packed->spheres = realloc(packed->spheres, CLOUD * sizeof *packed->spheres);
    assert_non_null(packed->spheres);
    packed->sphere_count = CLOUD;
    for (int i = 0; i < CLOUD; ++i) {
        float x = random_number(&random) - 0.5f, y = random_number(&random) - 0.5f,
              z = random_number(&random) - 0.5f, size = random_number(&random);
        packed->spheres[i] = (struct PackedSphere){
            {middle.x + x, middle.y + y, middle.z + z, 0.001f + 0.03f * size * size * size},
            {.SURFACE = i % packed->surface_count,
             .FILE_ORDER = CLOUD - i,
             .HOLDS_RAYS = 1,
             .HOLDS_LIGHTS = 1},
        };
    }
}

static void clouds(void **state)
{
    static const char *const names[] = {"scenes/figure_3b.yaml", "scenes/figure_4.yaml"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        struct scene scene = test_read(names[i]);
        struct packed_scene packed = pack(&scene);
        make_cloud(&packed);
        build_hierarchy(&packed); /* each sphere has kept its surface */
        check_picture(names[i], &packed);
        check_explanations(names[i], &packed);
        check_events(names[i], &packed);
        pack_destroy(&packed);
        scene_destroy(&scene);
    }
}

/* Each of the tree's allocations fails once. */
static void without_memory(void **state)
{
    struct scene scene = test_read("scenes/figure_4.yaml");
    struct packed_scene packed = pack(&scene), reference;
    enum status status = STATUS_UNABLE;
    int failures = 0;
    (void)state;
    build_hierarchy(&packed);
    for (; status != STATUS_DONE; ++failures) {
        calls_to_failure = failures;
        status = reference_scene(&packed, 1, &reference);
        bool failed = calls_to_failure < 0;
        calls_to_failure = -1;
        assert_int_equal(status, failed ? STATUS_UNABLE : STATUS_DONE);
        assert_true(failed == !reference.tree);
    }
    assert_true(failures > 1);
    pack_destroy(&packed);
    scene_destroy(&scene);
}

/* There is no tree of spheres that are looped over; and one for all packed scenes with the same spheres. */
static void tree_where_needed(void **state)
{
    struct scene scene = test_read("scenes/hard/camera_in_cloud.yaml");
    struct picture_settings settings = test_settings(&scene);
    struct packed_scene packed, moved, other, first, second;
    (void)state;
    packed = test_pack(&scene, settings);
    scene.camera.fov_y_degrees /= 2;
    scene.background[0] = 0.25;
    assert_int_equal(pack_scene(&packed, &scene, &settings, &moved), STATUS_DONE);
    assert_true(moved.hierarchy == packed.hierarchy && packed.hierarchy->owners == 2);
    scene.objects[0].spheres.rows[7][3] *= 1.5F;
    assert_int_equal(pack_scene(&packed, &scene, &settings, &other), STATUS_DONE);
    assert_ptr_not_equal(other.hierarchy, packed.hierarchy);
    assert_int_equal(reference_scene(&packed, 1, &first), STATUS_DONE);
    assert_non_null(first.tree);
    pack_destroy(&packed);
    assert_int_equal(reference_scene(&moved, 1, &second), STATUS_DONE);
    assert_ptr_equal(second.tree, first.tree);
    pack_destroy(&moved);
    pack_destroy(&other);
    scene_destroy(&scene);

    scene = test_read("scenes/figure_4.yaml");
    packed = pack(&scene);
    assert_int_equal(reference_scene(&packed, 1, &first), STATUS_DONE);
    assert_null(first.tree);
    pack_destroy(&packed);
    scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(clouds), cmocka_unit_test(without_memory),
                                       cmocka_unit_test(tree_where_needed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
