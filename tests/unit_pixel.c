/* What `pixel` shows is what the picture is made of: on the shipped scenes device and reference
 * tell the same steps, these add up to the picture's pixel, and the analysis bounds the error of each. */
#include "cmocka_test.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pixel/ray_tree.h"
#include "test_render.h"

enum { WIDTH = 60, HEIGHT = 40, PIXELS = 3 };
static const unsigned places[PIXELS][2] = {{34, 27}, {20, 23}, {29, 12}};

static struct packed_scene pack(const char *path, unsigned samples)
{
    struct scene scene;
    assert_int_equal(scene_read(path, &scene), STATUS_DONE);
    struct picture_settings settings = test_settings(&scene);
    settings.width = WIDTH;
    settings.height = HEIGHT;
    settings.samples = samples;
    settings.light_samples = 3;
    struct packed_scene packed = test_pack(&scene, settings);
    scene_destroy(&scene);
    return packed;
}

static struct render_plan plan_of(const struct packed_scene *packed, const unsigned place[2])
{
    return (struct render_plan){.scene = packed, .window = {place[0], place[1], 1, 1}, .quiet = true};
}

/* Knuth's two-sum, as both tracers gather a sample. */
static void add_exactly(float *sum, float *rounding, float leaf)
{
    float total = *sum + leaf, added = total - *sum;
    *rounding += (*sum - (total - added)) + (leaf - added);
    *sum = total;
}

/* The leaves make the samples, and the last event is the pixel. */
static void check_sums(const char *name, const struct ray_tree *events, const float *picture)
{
    float sum[3] = {0}, rounding[3] = {0};
    for (size_t i = 0; i < events->count; ++i) {
        const struct reference_event *event = &events->events[i];
        for (int c = 0; c < 3; ++c)
            if (event->head.place.EVENT_KIND == EVENT_LEAF) {
                add_exactly(&sum[c], &rounding[c], (float)event->values[3 + c]);
            } else if (event->head.place.EVENT_KIND == EVENT_SAMPLE) {
                assert_true((double)(sum[c] + rounding[c]) == event->values[c]);
                sum[c] = rounding[c] = 0;
            }
    }
    const struct reference_event *last = &events->events[events->count - 1];
    assert_int_equal(last->head.place.EVENT_KIND, EVENT_PIXEL);
    for (int c = 0; c < 3; ++c)
        if ((double)picture[c] != last->values[c]) {
            print_error("%s: the picture has %.9g, the events end in %.9g\n", name, (double)picture[c],
                        last->values[c]);
            fail();
        }
}

static void check_pixel(const char *name, const struct packed_scene *packed, const unsigned place[2])
{
    const struct render_plan plan = plan_of(packed, place);
    struct ray_tree device, reference;
    assert_int_equal(ray_tree_on_cpu(&plan, PRECISION_FLOAT, &reference), STATUS_DONE);
    assert_int_equal(ray_tree_on_device(test_context, &plan, reference.count, &device), STATUS_DONE);
    struct event_difference difference = ray_trees_compare(&device, &reference);
    if (difference.differs) {
        print_error("%s, pixel (%u, %u): %s of step %zu differs\n", name, place[0], place[1],
                    difference.field ? difference.field->name : "kind", difference.event);
        fail();
    }
    assert_int_equal(device.beyond + reference.beyond, 0);
    struct rendering rendering;
    assert_int_equal(render_on_device(test_context, &plan, &rendering), STATUS_DONE);
    check_sums(name, &device, rendering.image.rgb);
    image_destroy(&rendering.image);
    ray_tree_destroy(&device);
    ray_tree_destroy(&reference);
}

static glob_t shipped_scenes(void)
{
    glob_t paths;
    assert_int_equal(glob(SOURCE_DIR "/scenes/figure_*.yaml", 0, NULL, &paths), 0);
    assert_int_equal(glob(SOURCE_DIR "/scenes/hard/*.yaml", GLOB_APPEND, NULL, &paths), 0);
    return paths;
}

static void same_steps(void **state)
{
    (void)state;
    glob_t paths = shipped_scenes();
    for (size_t i = 0; i < paths.gl_pathc; i += 2) {
        struct packed_scene packed = pack(paths.gl_pathv[i], i % 4 ? 2 : 1);
        check_pixel(paths.gl_pathv[i], &packed, places[i % PIXELS]);
        pack_destroy(&packed);
    }
    globfree(&paths);
}

/* Where no decision is close, float's every quantity is within its bound of the exact one. */
static size_t check_bounds(const char *name, const struct ray_tree *device, const struct ray_tree *exact)
{
    size_t at = 0, checked = 0;
    for (size_t i = 0; i < exact->count; ++i, ++at) {
        while (device->events[at].head.place.EVENT_KIND == EVENT_SAMPLE)
            ++at;
        const struct reference_event *event = &exact->events[i];
        assert_memory_equal(&device->events[at].head, &event->head, sizeof event->head);
        for (const struct event_field *field = NULL; (field = event_next_field(event, field));)
            for (int c = 0; field->type == FIELD_VALUE && !field->not_analysed && c < field->count; ++c) {
                double error = event_value(&device->events[at], field, c) - event_value(event, field, c);
                ++checked;
                if (!(fabs(error) <= event->bounds[field->first + c])) {
                    print_error("%s, step %zu: %s is off by %g, its bound is %g\n", name, at, field->name,
                                error, event->bounds[field->first + c]);
                    fail();
                }
            }
    }
    return checked;
}

static void errors_within_bounds(void **state)
{
    (void)state;
    size_t checked = 0;
    glob_t paths = shipped_scenes();
    assert_int_equal(glob(SOURCE_DIR "/tests/scenes/*.yaml", GLOB_APPEND, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; ++i) {
        struct packed_scene packed = pack(paths.gl_pathv[i], 1);
        for (unsigned k = 0; k < WIDTH * HEIGHT; k += 97) {
            const struct render_plan plan = plan_of(&packed, (const unsigned[]){k % WIDTH, k / WIDTH});
            struct ray_tree rounded, exact;
            assert_int_equal(ray_tree_on_cpu(&plan, PRECISION_FLOAT, &rounded), STATUS_DONE);
            assert_int_equal(ray_tree_on_cpu(&plan, PRECISION_QUAD, &exact), STATUS_DONE);
            if (exact.events[exact.count - 1].margin >= 1)
                checked += check_bounds(paths.gl_pathv[i], &rounded, &exact);
            ray_tree_destroy(&rounded);
            ray_tree_destroy(&exact);
        }
        pack_destroy(&packed);
    }
    globfree(&paths);
    assert_true(checked > 10000);
}

/* What does not fit is counted. */
static void too_little_room(void **state)
{
    (void)state;
    enum { ROOM = 7 };
    struct packed_scene packed = pack(SOURCE_DIR "/scenes/figure_4.yaml", 2);
    const struct render_plan plan = plan_of(&packed, places[0]);
    struct ray_tree device, reference;
    assert_int_equal(ray_tree_on_cpu(&plan, PRECISION_FLOAT, &reference), STATUS_DONE);
    assert_int_equal(ray_tree_on_device(test_context, &plan, ROOM, &device), STATUS_DONE);
    assert_true(reference.count > ROOM);
    assert_int_equal(device.count, ROOM);
    assert_int_equal(device.count + device.beyond, reference.count);
    assert_false(ray_trees_compare(&device, &reference).differs);
    reference.events[ROOM - 1].values[0] += 1;
    assert_true(ray_trees_compare(&device, &reference).differs);
    ray_tree_destroy(&device);
    ray_tree_destroy(&reference);
    pack_destroy(&packed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_steps),
        cmocka_unit_test(errors_within_bounds),
        cmocka_unit_test(too_little_room),
    };
    return cmocka_run_group_tests(tests, test_open_device, test_close_device);
}
