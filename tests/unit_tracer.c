/* The picture's bits depend on the scene alone: not on how the work is cut up, nor where the scene's data
 * lie. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>

#include "check/compare.h"
#include "test_render.h"

enum { WIDTH = 333, HEIGHT = 217 };

/* Between them: matte, mirror, glass, both kinds of lights. */
static const char *const scene_names[] = {"scenes/figure_2b.yaml", "scenes/figure_4.yaml",
                                          "tests/scenes/glass_half_space.yaml"};
static const struct window whole_window = {0, 0, WIDTH, HEIGHT};
enum { SCENES = sizeof scene_names / sizeof *scene_names };

/* Packed, and traced whole with the tracer's own choices. */
static struct packed_scene packed_scenes[SCENES];
static struct image whole_pictures[SCENES];

static struct packed_scene pack(const char *name)
{
    struct scene scene = test_read(name);
    const struct picture_settings settings = {
        .width = WIDTH, .height = HEIGHT, .max_bounces = 5, .samples = 2, .light_samples = 3};
    struct packed_scene packed = test_pack(&scene, settings);
    scene_destroy(&scene);
    return packed;
}

static struct image trace(const struct packed_scene *packed, struct tracer_options options,
                          struct window window)
{
    struct tracer *tracer;
    struct image image;
    struct progress progress;
    struct tracer_times times;
    progress_start(&progress, "", (uint64_t)window.width * window.height, true);
    assert_int_equal(tracer_create(test_context, packed, &options, &tracer), STATUS_DONE);
    assert_int_equal(image_create(window.width, window.height, &image), STATUS_DONE);
    memset(image.rgb, 0xff, (size_t)window.width * window.height * 3 * sizeof(float));
    assert_int_equal(
        tracer_render(tracer, window, &(struct tracer_values){.image = &image}, &progress, &times),
        STATUS_DONE);
    assert_true(times.device_ms > 0 && times.dispatch_ms >= times.device_ms);
    assert_int_equal(progress.done, (uint64_t)window.width * window.height);
    tracer_destroy(&tracer);
    assert_null(tracer);
    return image;
}

static void check_same_part(const struct image *whole, const struct image *part, struct window window,
                            const char *what)
{
    for (unsigned y = 0; y < window.height; ++y)
        if (memcmp(whole->rgb + ((size_t)(window.y + y) * WIDTH + window.x) * 3,
                   part->rgb + (size_t)y * window.width * 3, window.width * 3 * sizeof(float)) != 0) {
            print_error("%s: row %u of window %u,%u,%u,%u differs\n", what, y, window.x, window.y,
                        window.width, window.height);
            fail();
        }
}

static void compare_with_whole(struct window window)
{
    for (int i = 0; i < SCENES; ++i) {
        struct image part = trace(&packed_scenes[i], (struct tracer_options){0}, window);
        check_same_part(&whole_pictures[i], &part, window, scene_names[i]);
        image_destroy(&part);
    }
}

/* A device whose storage buffers have room for so many pixels: below a row, a few rows, no divisor of
 * anything, more than the picture. */
static void tile_size(void **state)
{
    static const struct {
        uint32_t pixels;
        struct window window; /* small, where there are many tiles */
    } tiles[] = {{100, {0, 90, WIDTH, 20}}, {4096, {0, 0, WIDTH, HEIGHT}}};
    (void)state;
    uint32_t real_limit = test_context->properties.limits.maxStorageBufferRange;
    for (size_t i = 0; i < sizeof tiles / sizeof *tiles; ++i) {
        test_context->properties.limits.maxStorageBufferRange = tiles[i].pixels * 4 * (uint32_t)sizeof(float);
        compare_with_whole(tiles[i].window);
    }
    test_context->properties.limits.maxStorageBufferRange = real_limit;
}

static void crop(void **state)
{
    static const struct window windows[] = {{0, 0, 1, 1},
                                            {WIDTH - 1, HEIGHT - 1, 1, 1},
                                            {17, 31, 101, 67},
                                            {0, 100, WIDTH, 1},
                                            {200, 0, 1, HEIGHT}};
    (void)state;
    for (size_t i = 0; i < sizeof windows / sizeof *windows; ++i)
        compare_with_whole(windows[i]);
}

/* A device whose uniform buffers have no room for a single sphere. */
static void scene_in_storage_buffers(void **state)
{
    (void)state;
    uint32_t real_limit = test_context->properties.limits.maxUniformBufferRange;
    test_context->properties.limits.maxUniformBufferRange = 1;
    compare_with_whole(whole_window);
    test_context->properties.limits.maxUniformBufferRange = real_limit;
}

/* What fast mode may change is rounding: few pixels come out visibly different (those that look at an edge).
 */
static void fast_mode_is_close(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; ++i) {
        struct image fast = trace(&packed_scenes[i], (struct tracer_options){.fast = true}, whole_window);
        const struct tolerance tolerance = {1e-4, 1e-4};
        const struct comparison comparison = image_compare(&whole_pictures[i], &fast, &tolerance);
        assert_true(comparison.differing <= (size_t)WIDTH * HEIGHT / 200);
        assert_true(comparison.bit_differing > 0);
        image_destroy(&fast);
    }
}

static void ray_counts(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; ++i) {
        struct rendering device = test_render(&packed_scenes[i], TEST_DEVICE, (struct window){0});
        struct rendering reference = test_render(&packed_scenes[i], TEST_FLOAT, (struct window){0});
        assert_int_equal(device.rays.primary, WIDTH * HEIGHT * 2);
        assert_int_equal(device.rays.primary, reference.rays.primary);
        assert_int_equal(device.rays.secondary, reference.rays.secondary);
        assert_int_equal(device.rays.shadow, reference.rays.shadow);
        image_destroy(&device.image);
        image_destroy(&reference.image);
    }
}

/* One pixel's shadow rays are more than 2^24, the first number that float cannot count on from, and odd. */
static void ray_counts_of_one_pixel(void **state)
{
    enum { SAMPLES = 513, LIGHT_SAMPLES = 32767 };
    (void)state;
    struct scene scene = test_read("scenes/figure_2b.yaml");
    struct picture_settings settings = test_settings(&scene);
    settings.samples = SAMPLES;
    settings.light_samples = LIGHT_SAMPLES;
    struct packed_scene packed = test_pack(&scene, settings);
    scene_destroy(&scene);
    struct render_plan plan = {.scene = &packed, .window = {300, 350, 1, 1}, .quiet = true};
    struct reference_rays rays = {1, 2, 3};
    assert_int_equal(rays_on_device(test_context, &plan, &rays), STATUS_DONE);
    assert_int_equal(rays.primary, 1 + SAMPLES);
    assert_int_equal(rays.secondary, 2);
    assert_int_equal(rays.shadow, 3 + SAMPLES * LIGHT_SAMPLES);
    pack_destroy(&packed);
}

static int setup(void **state)
{
    if (test_open_device(state) != 0)
        return -1;
    for (int i = 0; i < SCENES; ++i) {
        packed_scenes[i] = pack(scene_names[i]);
        whole_pictures[i] = trace(&packed_scenes[i], (struct tracer_options){0}, whole_window);
    }
    return 0;
}

static int teardown(void **state)
{
    for (int i = 0; i < SCENES; ++i) {
        image_destroy(&whole_pictures[i]);
        pack_destroy(&packed_scenes[i]);
    }
    return test_close_device(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tile_size),
        cmocka_unit_test(crop),
        cmocka_unit_test(scene_in_storage_buffers),
        cmocka_unit_test(fast_mode_is_close),
        cmocka_unit_test(ray_counts),
        cmocka_unit_test(ray_counts_of_one_pixel),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
