/* What --max-error promises, and truncation_bound: no pixel is farther from the picture with 64 bounces. */
#include "cmocka_test.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scene/truncation.h"
#include "test_render.h"

static const double max_errors[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
enum { MAX_ERRORS = sizeof max_errors / sizeof *max_errors, ALL_BOUNCES = 64 };

static struct packed_scene pack(const struct scene *scene, struct picture_settings settings)
{
    settings.width = 72;
    settings.height = 48;
    settings.light_samples = 4;
    return test_pack(scene, settings);
}

static struct rendering render(const struct packed_scene *packed, bool on_device)
{
    struct rendering rendering;
    const struct render_plan plan = {
        .scene = packed,
        .window = {0, 0, (unsigned)packed->width, (unsigned)packed->height},
        .count_rays = !on_device,
        .bound_truncation = true,
        .quiet = true,
    };
    assert_int_equal(on_device ? render_on_device(test_context, &plan, &rendering)
                               : render_on_cpu(&plan, &rendering),
                     STATUS_DONE);
    return rendering;
}

/* The largest difference, which in no pixel is above the bound that the picture comes with. */
static double check_bounds(const char *name, const struct image *image, const struct image *all)
{
    double largest = 0;
    for (size_t i = 0; i < (size_t)image->width * image->height * 3; ++i) {
        double error = fabs((double)image->rgb[i] - (double)all->rgb[i]);
        largest = fmax(largest, error);
        if (!(error <= (double)image->truncation[i / 3])) {
            print_error("%s: pixel %zu is off by %g, its bound is %g\n", name, i / 3, error,
                        (double)image->truncation[i / 3]);
            fail();
        }
    }
    return largest;
}

static void check_same(const char *name, const struct rendering *device, const struct rendering *reference)
{
    size_t pixels = (size_t)device->image.width * device->image.height;
    if (memcmp(device->image.rgb, reference->image.rgb, pixels * 3 * sizeof(float)) != 0 ||
        memcmp(device->image.truncation, reference->image.truncation, pixels * sizeof(float)) != 0) {
        print_error("%s: device and reference differ\n", name);
        fail();
    }
}

static void check_max_errors(const char *name, const struct scene *scene, struct picture_settings settings,
                             const struct rendering *all)
{
    for (int i = 0; i < MAX_ERRORS; ++i) {
        settings.has_max_error = true;
        settings.max_error = max_errors[i];
        struct packed_scene packed = pack(scene, settings);
        struct rendering reference = render(&packed, false);
        double error = check_bounds(name, &reference.image, &all->image);
        if (!(error <= max_errors[i])) {
            print_error("%s: off by %g with max_error %g\n", name, error, max_errors[i]);
            fail();
        }
        assert_true(reference.rays.secondary <= all->rays.secondary);
        if (max_errors[i] == 1e-3) {
            struct rendering device = render(&packed, true);
            check_same(name, &device, &reference);
            image_destroy(&device.image);
        }
        image_destroy(&reference.image);
        pack_destroy(&packed);
    }
}

static void check_scene(const char *path, unsigned samples)
{
    struct scene scene;
    assert_int_equal(scene_read(path, &scene), STATUS_DONE);
    struct picture_settings settings = test_settings(&scene);
    settings.samples = samples;
    struct packed_scene as_written = pack(&scene, settings);
    settings.max_bounces = ALL_BOUNCES;
    struct packed_scene deep = pack(&scene, settings);
    struct rendering all = render(&deep, false), reference = render(&as_written, false);
    check_bounds(path, &reference.image, &all.image);
    check_max_errors(path, &scene, settings, &all);
    image_destroy(&all.image);
    image_destroy(&reference.image);
    pack_destroy(&as_written);
    pack_destroy(&deep);
    scene_destroy(&scene);
}

static void shipped_scenes(void **state)
{
    (void)state;
    glob_t paths;
    assert_int_equal(glob(SOURCE_DIR "/scenes/figure_*.yaml", 0, NULL, &paths), 0);
    assert_int_equal(glob(SOURCE_DIR "/scenes/hard/*.yaml", GLOB_APPEND, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; ++i)
        check_scene(paths.gl_pathv[i], 1);
    globfree(&paths);
}

/* The samples of a pixel keep the promise together, whatever order their sums are rounded in. */
static void several_samples(void **state)
{
    (void)state;
    check_scene(SOURCE_DIR "/scenes/hard/diamond.yaml", 3);
}

/* Cost follows the light: four panes of glass have millions of rays a pixel with 24 bounces, and 2^200 with
 * 200. */
static void few_rays_for_little_light(void **state)
{
    (void)state;
    struct scene scene = test_read("tests/scenes/panes.yaml");
    struct picture_settings settings = test_settings(&scene);
    settings.max_bounces = 200;
    settings.has_max_error = true;
    settings.max_error = 1e-2;
    struct packed_scene packed = pack(&scene, settings);
    struct rendering reference = render(&packed, false), device = render(&packed, true);
    check_same("panes", &device, &reference);
    for (size_t i = 0; i < 72 * 48; ++i)
        assert_true((double)reference.image.truncation[i] <= 1e-2);
    assert_true(reference.rays.secondary < 300 * reference.rays.primary);
    image_destroy(&reference.image);
    image_destroy(&device.image);
    pack_destroy(&packed);
    scene_destroy(&scene);
}

/* The rays of the best threshold on weight, the same for the whole picture, by bisection over pictures traced
 * with a fixed one: 200 bounces, 18x12 pixels (panes: 4x3, all alike). */
static void no_more_than_twice_the_fewest_rays(void **state)
{
    static const struct {
        const char *scene;
        unsigned width, height;
        double max_error;
        uint64_t fewest;
    } cases[] = {
        {"tests/scenes/panes.yaml", 4, 3, 1e-1, 468},      {"tests/scenes/panes.yaml", 4, 3, 1e-2, 2460},
        {"tests/scenes/panes.yaml", 4, 3, 1e-3, 22244},    {"tests/scenes/shells.yaml", 18, 12, 1e-1, 1316},
        {"tests/scenes/shells.yaml", 18, 12, 1e-2, 31360}, {"scenes/hard/diamond.yaml", 18, 12, 1e-1, 368},
        {"scenes/hard/diamond.yaml", 18, 12, 1e-3, 554},   {"scenes/hard/diamond.yaml", 18, 12, 1e-5, 835},
        {"scenes/hard/touching.yaml", 18, 12, 1e-1, 296},  {"scenes/hard/touching.yaml", 18, 12, 1e-3, 362},
        {"scenes/hard/touching.yaml", 18, 12, 1e-5, 473},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct scene scene = test_read(cases[i].scene);
        struct picture_settings settings = test_settings(&scene);
        settings.width = cases[i].width;
        settings.height = cases[i].height;
        settings.max_bounces = 200;
        settings.has_max_error = true;
        settings.max_error = cases[i].max_error;
        struct packed_scene packed = test_pack(&scene, settings);
        struct rendering rendering = render(&packed, false);
        uint64_t rays = rendering.rays.primary + rendering.rays.secondary;
        if (rays > 2 * cases[i].fewest)
            fail_msg("%s: %ju rays for %g", cases[i].scene, (uintmax_t)rays, cases[i].max_error);
        image_destroy(&rendering.image);
        pack_destroy(&packed);
        scene_destroy(&scene);
    }
}

/* On facing mirrors most of the work is in what nobody sees. */
static void half_of_the_rays(void **state)
{
    static const char *const names[] = {"scenes/hard/facing_mirrors.yaml",
                                        "scenes/hard/mirror_corridor.yaml"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        struct scene scene = test_read(names[i]);
        struct picture_settings settings = test_settings(&scene);
        uint64_t rays[2];
        for (int k = 0; k < 2; ++k) {
            settings.has_max_error = k == 1;
            settings.max_error = 1e-3;
            struct packed_scene packed = pack(&scene, settings);
            struct rendering rendering = render(&packed, false);
            rays[k] = rendering.rays.primary + rendering.rays.secondary + rendering.rays.shadow;
            image_destroy(&rendering.image);
            pack_destroy(&packed);
        }
        assert_true(rays[1] < rays[0] / 2);
        scene_destroy(&scene);
    }
}

static uint64_t random_state = 1;

/* Uniform in [low, high): the upper bits of Knuth's MMIX generator. */
static double uniform(double low, double high)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

static void set(double v[3], double x, double y, double z)
{
    v[0] = x;
    v[1] = y;
    v[2] = z;
}

/* The mirrors of the corridor stand askew, and among the balls there are some that only lost rays could meet
 * if they were not lost. */
static void randomize(struct scene *scene)
{
    double tilt = uniform(-0.3, 0.3), x = sin(tilt), z = cos(tilt);
    for (size_t i = 0; i < scene->object_count; ++i) {
        struct scene_object *object = &scene->objects[i];
        if (object->type == OBJECT_SPHERE) {
            set(object->sphere.center, uniform(-20, 20), uniform(-1, 20), uniform(-4, 4));
            object->sphere.radius = exp(uniform(-3, 1));
        } else if (object->plane.normal[1] == 0) {
            double side = object->plane.point[2] > 0 ? -1 : 1;
            set(object->plane.normal, side * x, 0, side * z);
        }
    }
}

static void lost_rays_bring_nothing(void **state)
{
    (void)state;
    uint64_t rays = 0, all_rays = 0;
    for (int seed = 1; seed <= 60; ++seed) {
        struct scene scene = test_read("scenes/hard/mirror_corridor.yaml");
        struct picture_settings settings = test_settings(&scene);
        random_state = (uint64_t)seed;
        randomize(&scene);
        settings.max_bounces = 400;
        struct packed_scene all = pack(&scene, settings), pruned;
        settings.has_max_error = true; /* 0 */
        pruned = pack(&scene, settings);
        struct rendering expected = render(&all, false), got = render(&pruned, false);
        if (memcmp(expected.image.rgb, got.image.rgb, sizeof(float) * 3 * 72 * 48) != 0)
            fail_msg("seed %d: rays that bring something were left out", seed);
        rays += got.rays.secondary;
        all_rays += expected.rays.secondary;
        image_destroy(&expected.image);
        image_destroy(&got.image);
        pack_destroy(&all);
        pack_destroy(&pruned);
        scene_destroy(&scene);
    }
    assert_true(rays < all_rays / 10);
}

/* Balls of two kinds of glass, one in another or across its surface, and more or less light behind. */
static void randomize_glass(struct scene *scene)
{
    for (size_t i = 0; i < scene->material_count; ++i)
        scene->materials[i].ior = exp(uniform(-1, 1));
    for (size_t i = 0; i < scene->object_count; ++i)
        if (scene->objects[i].type == OBJECT_SPHERE) {
            set(scene->objects[i].sphere.center, uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            scene->objects[i].sphere.radius = exp(uniform(-2, 1));
            scene->objects[i].material = 1 + (uniform(0, 1) < 0.5);
        }
    for (int c = 0; c < 3; ++c)
        scene->background[c] = exp(uniform(-6, 2));
}

/* Against the whole tree of as many bounces, in double. */
static void random_scenes_keep_the_order(void **state)
{
    (void)state;
    uint64_t rays = 0, all_rays = 0;
    for (int seed = 1; seed <= 20; ++seed) {
        struct scene scene = test_read("tests/scenes/shells.yaml");
        struct picture_settings settings = test_settings(&scene);
        random_state = (uint64_t)seed;
        randomize_glass(&scene);
        settings.width = 12;
        settings.height = 8;
        settings.max_bounces = (unsigned)uniform(3, 11);
        struct packed_scene all = test_pack(&scene, settings);
        struct render_plan plan = {
            .window = {0, 0, 12, 8},
            .precision = PRECISION_DOUBLE,
            .count_rays = true,
            .bound_truncation = true,
            .quiet = true,
        };
        struct rendering expected, got;
        plan.scene = &all;
        assert_int_equal(render_on_cpu(&plan, &expected), STATUS_DONE);
        for (double max_error = 1; max_error > 1e-6; max_error *= 0.1) {
            settings.has_max_error = true;
            settings.max_error = max_error;
            struct packed_scene packed = test_pack(&scene, settings);
            plan.scene = &packed;
            assert_int_equal(render_on_cpu(&plan, &got), STATUS_DONE);
            for (size_t i = 0; i < 12 * 8; ++i) {
                double bound = (double)got.image.truncation[i],
                       cut_off = (double)expected.image.truncation[i];
                double error = 0;
                for (size_t c = 3 * i; c < 3 * i + 3; ++c)
                    error = fmax(error, fabs(got.image.rgb64[c] - expected.image.rgb64[c]));
                if (!(error <= bound) || error > max_error || (cut_off == 0 && bound > max_error))
                    fail_msg("seed %d, pixel %zu: off by %g, bound %g, ordered %g", seed, i, error, bound,
                             max_error);
            }
            assert_true(got.rays.secondary <= expected.rays.secondary);
            rays += got.rays.secondary;
            all_rays += expected.rays.secondary;
            image_destroy(&got.image);
            pack_destroy(&packed);
        }
        image_destroy(&expected.image);
        pack_destroy(&all);
        scene_destroy(&scene);
    }
    assert_true(rays < all_rays * 3 / 4); /* there is something to leave out */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shipped_scenes),
        cmocka_unit_test(several_samples),
        cmocka_unit_test(few_rays_for_little_light),
        cmocka_unit_test(no_more_than_twice_the_fewest_rays),
        cmocka_unit_test(half_of_the_rays),
        cmocka_unit_test(random_scenes_keep_the_order),
        cmocka_unit_test(lost_rays_bring_nothing),
    };
    return cmocka_run_group_tests(tests, test_open_device, test_close_device);
}
