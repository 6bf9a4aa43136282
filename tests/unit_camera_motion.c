#include "cmocka_test.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "scene/pack.h"
#include "scene/scene.h"
#include "scene/vector.h"
#include "watch/camera_motion.h"

static const double pi = 3.14159265358979323846;

static const struct scene_camera figure_camera = {
    .position = {0, 2, -6}, .look_at = {0, 2, 0}, .up = {0, 1, 0}, .fov_y_degrees = 60};

static uint64_t random_state;

/* Uniform in [0, 1). */
static double random_unit(void)
{
    random_state = random_state * 6364136223846793005U + 1442695040888963407U;
    return (double)(random_state >> 11) * 0x1p-53;
}

static double random_coordinate(double size)
{
    return size * (2 * random_unit() - 1);
}

static struct scene_camera random_camera(void)
{
    double size = pow(10, 20 * random_unit() - 10);
    struct scene_camera camera = {.fov_y_degrees = 1 + 178 * random_unit()};
    for (int i = 0; i < 3; ++i) {
        camera.position[i] = random_coordinate(size);
        camera.look_at[i] = random_coordinate(size);
        camera.up[i] = random_coordinate(1 / size);
    }
    return camera;
}

static struct dvec3 offset_of(const struct scene_camera *camera)
{
    return dvec3_subtract(dvec3_of(camera->position), dvec3_of(camera->look_at));
}

/* What rounding the coordinates can change of a distance. */
static double rounding_of(const struct scene_camera *camera)
{
    return 0x1p-49 * (dvec3_length(dvec3_of(camera->position)) + dvec3_length(dvec3_of(camera->look_at)));
}

static double polar_angle(const struct scene_camera *camera)
{
    struct dvec3 outward = dvec3_unit(offset_of(camera)), up = dvec3_unit(dvec3_of(camera->up));
    return atan2(dvec3_length(dvec3_cross(outward, up)), dvec3_dot(outward, up));
}

/* Where a point is in the picture, in picture heights from the middle, as the packer defines the view. */
static void project(const struct scene_camera *camera, struct dvec3 point, double at[2])
{
    struct dvec3 forward = dvec3_unit(dvec3_scale(-1, offset_of(camera)));
    struct dvec3 right = dvec3_unit(dvec3_cross(forward, dvec3_of(camera->up)));
    struct dvec3 down = dvec3_cross(forward, right);
    struct dvec3 ray = dvec3_subtract(point, dvec3_of(camera->position));
    double picture_height = 2 * tan(camera->fov_y_degrees / 180 * pi / 2) * dvec3_dot(ray, forward);
    at[0] = dvec3_dot(ray, right) / picture_height;
    at[1] = dvec3_dot(ray, down) / picture_height;
}

/* The reader takes what camera_print() writes and finds the same bits. */
static void assert_round_trip(const struct scene_camera *camera)
{
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    assert_non_null(stream);
    camera_print(stream, camera);
    fputs("image: { width: 2, height: 2 }\n", stream);
    assert_int_equal(fclose(stream), 0);
    struct scene scene;
    if (scene_read_text("printed.yaml", text, length, &scene) != STATUS_DONE)
        fail_msg("refused: %s", text);
    assert_memory_equal(&scene.camera, camera, sizeof *camera);
    scene_destroy(&scene);
    free(text);
}

/* The packed view has finite unit vectors. */
static void assert_packs(const struct scene_camera *camera)
{
    const struct scene scene = {.path = (char[]){"moved"}, .camera = *camera};
    struct packed_scene packed;
    const struct picture_settings settings = {
        .width = 3, .height = 2, .max_bounces = 1, .samples = 1, .light_samples = 1};
    assert_int_equal(pack_scene(NULL, &scene, &settings, &packed), STATUS_DONE);
    const float *vectors[] = {&packed.view.forward.x, &packed.view.half_pixel_right.x,
                              &packed.view.half_pixel_down.x};
    double half_pixel = tan(camera->fov_y_degrees / 180 * pi / 2) / 2;
    for (int i = 0; i < 3; ++i) {
        double length = hypot(hypot((double)vectors[i][0], (double)vectors[i][1]), (double)vectors[i][2]);
        assert_true(fabs(length / (i == 0 ? 1 : half_pixel) - 1) < 1e-6);
    }
    pack_destroy(&packed);
}

static void test_orbit_keeps_distance(void **state)
{
    (void)state;
    for (random_state = 0; random_state < 2000; ++random_state) {
        uint64_t seed = random_state;
        struct scene_camera camera = random_camera(), moved = camera;
        double x = random_coordinate(2), y = random_coordinate(2);
        camera_orbit(&moved, x, y);
        double change = fabs(dvec3_length(offset_of(&moved)) - dvec3_length(offset_of(&camera)));
        if (!(change <= rounding_of(&camera)))
            fail_msg("seed %u: the distance changed by %g", (unsigned)seed, change);
        assert_memory_equal(moved.look_at, camera.look_at, sizeof camera.look_at);
        assert_memory_equal(moved.up, camera.up, sizeof camera.up);

        double polar = polar_angle(&camera), expected = polar - pi * y;
        expected = fmax(fmin(expected, fmax(polar, 179 * pi / 180)), fmin(polar, pi / 180));
        assert_true(fabs(polar_angle(&moved) - expected) < 1e-12);
        random_state = seed;
    }
}

/* Dragging to the right shows the left side; dragging down, the top. Half a turn a picture height. */
static void test_orbit_directions(void **state)
{
    (void)state;
    struct scene_camera camera = figure_camera;
    camera_orbit(&camera, 0.5, 0); /* left is +x, the view being along +z */
    const double left[3] = {6, 2, 0}, raised[3] = {0, 2 + 6 * sqrt(0.5), -6 * sqrt(0.5)};
    for (int i = 0; i < 3; ++i)
        assert_true(fabs(camera.position[i] - left[i]) < 1e-14);
    camera = figure_camera;
    camera_orbit(&camera, 0, 0.25);
    for (int i = 0; i < 3; ++i)
        assert_true(fabs(camera.position[i] - raised[i]) < 1e-14);
}

static void test_orbit_stops_at_the_poles(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        struct scene_camera camera = figure_camera;
        for (int i = 0; i < 100; ++i)
            camera_orbit(&camera, 0.1, sign * 0.3);
        double from_pole = sign > 0 ? polar_angle(&camera) : pi - polar_angle(&camera);
        assert_true(fabs(from_pole - pi / 180) < 1e-12);
        camera_orbit(&camera, 0, -sign * 0.5);
        assert_true(fabs(polar_angle(&camera) - pi / 2 - sign * pi / 180) < 1e-12);
    }
}

/* A point as far away as look_at is where the pointer took it. */
static void test_pan_follows_the_pointer(void **state)
{
    (void)state;
    for (random_state = 0; random_state < 2000; ++random_state) {
        uint64_t seed = random_state;
        struct scene_camera camera = random_camera(), moved = camera;
        struct dvec3 side = dvec3_cross(offset_of(&camera), dvec3_unit(dvec3_of(camera.up)));
        struct dvec3 point = dvec3_add(dvec3_of(camera.look_at), dvec3_scale(random_coordinate(1), side));
        double x = random_coordinate(2), y = random_coordinate(2), before[2], after[2];
        camera_pan(&moved, x, y);
        project(&camera, point, before);
        project(&moved, point, after);
        double error = fmax(fabs(after[0] - before[0] - x), fabs(after[1] - before[1] - y));
        double relative_rounding = rounding_of(&moved) / dvec3_length(offset_of(&camera));
        if (!(error <= 1e-10 + 100 * relative_rounding))
            fail_msg("seed %u: off by %g picture heights", (unsigned)seed, error);
        struct dvec3 turned = dvec3_subtract(offset_of(&moved), offset_of(&camera));
        assert_true(dvec3_length(turned) <= rounding_of(&moved));
        random_state = seed;
    }
}

static void test_zoom_is_a_factor(void **state)
{
    (void)state;
    for (random_state = 0; random_state < 2000; ++random_state) {
        uint64_t seed = random_state;
        struct scene_camera camera = random_camera(), moved = camera;
        double steps = random_coordinate(20);
        camera_zoom(&moved, steps);
        double expected = dvec3_length(offset_of(&camera)) * pow(1.1, -steps);
        double error = fabs(dvec3_length(offset_of(&moved)) - expected);
        if (!(error <= rounding_of(&camera) + rounding_of(&moved) + 1e-14 * expected))
            fail_msg("seed %u: %g steps lead to %g instead of %g", (unsigned)seed, steps,
                     dvec3_length(offset_of(&moved)), expected);
        assert_memory_equal(moved.look_at, camera.look_at, sizeof camera.look_at);
        random_state = seed;
    }
}

/* Small, huge, infinite and NaN. */
static double hostile_amount(void)
{
    static const double amounts[] = {0, -0.0, INFINITY, -INFINITY, NAN, 1e308, -1e308, 0x1p-1074, 1e15};
    double choice = random_unit();
    if (choice < 0.2)
        return amounts[(size_t)(random_unit() * sizeof amounts / sizeof amounts[0])];
    return random_coordinate(choice < 0.4 ? pow(10, 40 * random_unit() - 20) : 1);
}

static void test_hostile_motions(void **state)
{
    (void)state;
    for (random_state = 0; random_state < 200; ++random_state) {
        uint64_t seed = random_state;
        struct scene_camera camera = seed % 2 ? random_camera() : figure_camera;
        bool has_moved = false;
        for (int i = 0; i < 200; ++i) {
            struct scene_camera before = camera;
            double motion = random_unit(), x = hostile_amount(), y = hostile_amount();
            if (motion < 0.4)
                camera_orbit(&camera, x, y);
            else if (motion < 0.8)
                camera_pan(&camera, x, y);
            else
                camera_zoom(&camera, x);
            has_moved = has_moved || memcmp(&before, &camera, sizeof camera) != 0;
            if (i % 10 == 0)
                assert_round_trip(&camera);
            assert_packs(&camera);
        }
        assert_true(has_moved);
        random_state = seed;
    }
}

/* On and on in the same direction it comes to a stop, and back again it moves. */
static void test_ends_of_the_world(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        const struct scene_camera start = {{0.1, 3, -6}, {1, 2, 3}, {0, 1, 0}, 60};
        struct scene_camera zoomed = start, panned = start, before;
        for (int i = 0; i < 1000; ++i) {
            camera_zoom(&zoomed, sign * 3);
            camera_pan(&panned, sign * 1e5, sign * 2e5);
        }
        assert_round_trip(&zoomed);
        assert_round_trip(&panned);
        assert_packs(&zoomed);
        assert_packs(&panned);
        double distance = dvec3_length(offset_of(&zoomed));
        assert_true(sign > 0 ? distance < 1e-7 : distance > 1e14);
        struct dvec3 turned = dvec3_subtract(dvec3_unit(offset_of(&zoomed)), dvec3_unit(offset_of(&start)));
        assert_true(dvec3_length(turned) < 0x1p-22);
        assert_true(fabs(panned.position[1]) > 1e8);
        before = panned;
        camera_zoom(&zoomed, -sign * 3);
        assert_true(fabs(dvec3_length(offset_of(&zoomed)) / distance - pow(1.1, sign * 3)) < 1e-6);
        camera_pan(&panned, -sign * 1e5, -sign * 2e5);
        assert_true(fabs(panned.position[1]) < fabs(before.position[1]));
    }
}

static void test_print(void **state)
{
    (void)state;
    const struct scene_camera camera = {{0.1, -2, 1e-7}, {1.0 / 3, 2, 1e15}, {0, 1, -0.0}, 60};
    static const char expected[] =
        "camera: { position: [0.1, -2, 1e-07], look_at: [0.3333333333333333, 2, 1e+15], "
        "up: [0, 1, -0], fov_y: 60 }\n";
    static const char *const locales[] = {"C", "de_DE.UTF-8", "C.UTF-8"};
    for (size_t i = 0; i < sizeof locales / sizeof *locales; ++i) {
        setlocale(LC_ALL, locales[i]);
        char text[512] = "";
        FILE *stream = fmemopen(text, sizeof text, "w");
        camera_print(stream, &camera);
        fclose(stream);
        assert_string_equal(text, expected);
    }
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orbit_keeps_distance),     cmocka_unit_test(test_orbit_directions),
        cmocka_unit_test(test_orbit_stops_at_the_poles), cmocka_unit_test(test_pan_follows_the_pointer),
        cmocka_unit_test(test_zoom_is_a_factor),         cmocka_unit_test(test_hostile_motions),
        cmocka_unit_test(test_ends_of_the_world),        cmocka_unit_test(test_print),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
