/* The device with its hierarchy of boxes against the reference that tries all spheres, on purpose where
 * roundings decide; and with another hierarchy over the same spheres: the same in every bit. */
#include "../cmocka_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hostile_spheres.h"
#include "needy_ray.h"
#include "tracer/dispatch.h"
#include "vulkan/probe.h"

enum { GROUP = 64, CASES = 1 << 14, NEEDY_RAYS = 64, INPUTS = SCENE_BINDINGS, OUTPUTS, USED_BINDINGS };

/* As in hierarchy.comp. */
struct input {
    float origin[3];
    int surface;
    float direction[3], inward;
    float from[3];
    int from_surface;
    float to[3], from_inward;
    float way[3], length;
};
struct output {
    int surface, from_inside, blocked, rounds;
    float distance[4];
};

static struct vulkan_context *context;
static struct vulkan_pass
    passes[MOST_HOSTILE_SPHERES + 1]; /* by the number of spheres that are looped over */
static struct vulkan_buffer inputs, outputs;

static void create_pass(int looped)
{
    static uint32_t words[1 << 16];
    FILE *file = fopen(SPIRV_FOLDER "/hierarchy.spv", "rb");
    assert_non_null(file);
    const size_t count = fread(words, sizeof *words, sizeof words / sizeof *words, file);
    fclose(file);
    const struct pass_constant constants[] = {
        {2, (uint32_t)looped},      {3, 0}, {4, 0}, {5, 0}, {13, 1}, {14, 1}, {16, 1}, {28, 0},
        {30, MOST_HOSTILE_SPHERES},
    };
    VkDescriptorType bindings[USED_BINDINGS];
    for (uint32_t i = 0; i < USED_BINDINGS; ++i)
        bindings[i] = binding_type(i, true);
    assert_int_equal(vulkan_pass_create(context,
                                        &(struct pass_info){
                                            .name = "hierarchy.comp",
                                            .code = {words, count * sizeof *words},
                                            .constants = constants,
                                            .constant_count = sizeof constants / sizeof *constants,
                                            .bindings = bindings,
                                            .binding_count = USED_BINDINGS,
                                        },
                                        &passes[looped]),
                     STATUS_DONE);
}

/* A ray that passes near the point where a sphere touches its box, along the box's side. */
static struct ray ray_along_side(struct random *random, const struct hostile_scene *scene)
{
    const struct PackedSphere *sphere =
        &scene->spheres[random_below(random, (unsigned)scene->without.sphere_count)];
    const layout_vec4 shape = sphere->center_radius;
    const double radius = (double)shape.w, way = random_scale(random, radius * 1e-2, 2);
    const double error = 0x1p-24 * (way + radius);
    const struct dvec3 normal = random_axis(random);
    const struct dvec3 direction = random_tangent(random, normal);
    struct dvec3 origin = {(double)shape.x, (double)shape.y, (double)shape.z};
    origin = dvec3_along(origin, radius + error * random_between(random, -8, 8), normal);
    origin = dvec3_along(origin, sqrt(2 * radius * error) * random_between(random, -3, 3),
                         dvec3_cross(normal, direction));
    origin = dvec3_along(origin, -way, direction);
    return (struct ray){round_vector(origin), round_vector(direction), NO_SURFACE, false};
}

static void write_input(const struct ray *ray, const struct segment *segment, struct input *input)
{
    *input = (struct input){
        .origin = {ray->origin.x, ray->origin.y, ray->origin.z},
        .surface = ray->surface,
        .direction = {ray->direction.x, ray->direction.y, ray->direction.z},
        .inward = ray->inward,
        .from = {segment->from.x, segment->from.y, segment->from.z},
        .from_surface = segment->surface,
        .to = {segment->to.x, segment->to.y, segment->to.z},
        .from_inward = segment->inward,
        .way = {segment->direction.x, segment->direction.y, segment->direction.z},
        .length = segment->length,
    };
}

static void run(struct packed_scene *packed, int cases)
{
    struct scene_buffer memory;
    assert_int_equal(scene_buffer_create(context, packed, true, &memory), STATUS_DONE);
    VkDescriptorBufferInfo buffers[USED_BINDINGS];
    memcpy(buffers, memory.parts, sizeof memory.parts);
    buffers[INPUTS] = (VkDescriptorBufferInfo){inputs.buffer, 0, VK_WHOLE_SIZE};
    buffers[OUTPUTS] = (VkDescriptorBufferInfo){outputs.buffer, 0, VK_WHOLE_SIZE};
    VkBufferView texels[USED_BINDINGS] = {
        [RECORDS] = memory.texels[RECORDS], [RECORD_WORDS] = memory.texels[RECORD_WORDS]};
    if (!passes[packed->looped_spheres].pipeline)
        create_pass(packed->looped_spheres);
    struct pass_frame frame;
    assert_int_equal(pass_frame_create(&passes[packed->looped_spheres], buffers, texels, &frame),
                     STATUS_DONE);
    assert_int_equal(pass_frame_submit(&frame, &(struct pass_dispatch){.groups_x = (uint32_t)(cases / GROUP),
                                                                       .groups_y = 1}),
                     STATUS_DONE);
    assert_int_equal(pass_frame_wait(&frame, NULL), STATUS_DONE);
    pass_frame_destroy(&frame);
    scene_buffer_destroy(context, &memory);
}

struct counts {
    long met, blocked, resumed, wrong;
};

static void compare(const struct packed_scene *scene, const struct ray *ray, const struct segment *segment,
                    const struct output *output, struct counts *counts)
{
    struct hit hit;
    const bool met = find_hit(scene, ray, &hit);
    const bool blocked = is_blocked(scene, segment);
    counts->met += met;
    counts->blocked += blocked;
    counts->resumed += output->rounds > 0;
    const bool same_hit = output->surface == (met ? hit.surface : NO_SURFACE) &&
                          (!met || (output->from_inside == hit.from_inside &&
                                    memcmp(output->distance, &hit.distance, sizeof hit.distance) == 0));
    if (same_hit && output->blocked == blocked)
        return;
    if (++counts->wrong < 10)
        print_error("surface %d at %.9g, %sblocked; not %d at %.9g, %sblocked\n", output->surface,
                    (double)output->distance[0], output->blocked ? "" : "not ", hit.surface,
                    (double)hit.distance, blocked ? "" : "not ");
}

/* A hierarchy that parts the spheres by their number: boxes that overlap at will. */
static void halve(struct hierarchy *hierarchy, const struct PackedSphere *spheres, uint32_t node,
                  uint32_t *next, uint32_t first, uint32_t count)
{
    struct hierarchy one;
    assert_int_equal(hierarchy_build(spheres, first, count, &one), STATUS_DONE);
    hierarchy->nodes[node] = one.nodes[0];
    hierarchy_destroy(&one);
    if (count == 1)
        return;
    const uint32_t left = *next;
    hierarchy->nodes[node].left = left;
    *next += 2;
    halve(hierarchy, spheres, left, next, first, count / 2);
    halve(hierarchy, spheres, left + 1, next, first + count / 2, count - count / 2);
}

static void test_scene(struct random *random, struct counts *counts, bool halved)
{
    static struct ray rays[CASES];
    static struct segment segments[CASES];
    struct hostile_scene scene;
    struct hierarchy hierarchy;
    hostile_scene_create(random, MOST_HOSTILE_SPHERES, &scene);
    struct packed_scene packed = scene.without;
    const uint32_t looped = (uint32_t)packed.looped_spheres, others = (uint32_t)packed.sphere_count - looped;
    if (halved) {
        uint32_t next = 1;
        hierarchy = (struct hierarchy){.nodes = calloc(2 * others, sizeof *hierarchy.nodes),
                                       .node_count = 2 * others - 1};
        halve(&hierarchy, scene.spheres, 0, &next, looped, others);
    } else {
        assert_int_equal(hierarchy_build(scene.spheres, looped, others, &hierarchy), STATUS_DONE);
    }
    packed.hierarchy = &hierarchy;
    packed.surface_count = 1;
    for (int i = 0; i < CASES; ++i) {
        rays[i] = random_bool(random) ? ray_along_side(random, &scene) : hostile_ray(random, &scene);
        segments[i] = hostile_segment(random, &scene);
        write_input(&rays[i], &segments[i], (struct input *)inputs.mapped + i);
    }
    run(&packed, CASES);
    for (int i = 0; i < CASES; ++i)
        compare(&scene.without, &rays[i], &segments[i], (const struct output *)outputs.mapped + i, counts);
    hierarchy_destroy(&hierarchy);
    hostile_scene_destroy(&scene);
}

static void test_hierarchies(void **state)
{
    struct counts counts = {0};
    (void)state;
    for (uint64_t i = 0; i < SCENES; ++i)
        for (int halved = 0; halved < 2; ++halved) {
            struct random random = random_start(13, 0, i);
            test_scene(&random, &counts, halved);
        }
    const long cases = 2L * SCENES * CASES;
    print_message(
        "%ld rays and segments, %ld hits, %ld blocked, %ld in several rounds: %ld are not as without the "
        "hierarchy\n",
        cases, counts.met, counts.blocked, counts.resumed, counts.wrong);
    assert_true(counts.met > cases / 4 && counts.blocked > cases / 4 && counts.resumed > cases / 8);
    assert_int_equal(counts.wrong, 0);
}

/* Rays for which a quarter of the slack is too little. */
static void test_slack(void **state)
{
    struct counts counts = {0};
    int needy_rays = 0;
    (void)state;
    for (uint64_t i = 0; needy_rays < NEEDY_RAYS; ++i) {
        struct random random = random_start(14, 0, i);
        struct needy_ray needy;
        assert_true(i < 100 * NEEDY_RAYS);
        if (!needy_ray_create(&random, 0.25F, &needy))
            continue;
        ++needy_rays;
        struct segment none = {.from = needy.ray.origin, .to = needy.ray.origin, .surface = NO_SURFACE};
        none.direction = needy.ray.direction;
        for (int k = 0; k < GROUP; ++k)
            write_input(&needy.ray, &none, (struct input *)inputs.mapped + k);
        run(&needy.scene, GROUP);
        for (int k = 0; k < 2; ++k) /* with many and few steps at a time */
            compare(&needy.scene, &needy.ray, &none, (const struct output *)outputs.mapped + k, &counts);
        hierarchy_destroy(&needy.hierarchy);
    }
    assert_int_equal(counts.wrong, 0);
}

int main(void)
{
    const struct vulkan_options options = {.validate = true};
    if (vulkan_context_create(&options, &context) != STATUS_DONE)
        return EXIT_FAILURE;
    if (vulkan_buffer_create(context, "inputs", CASES * sizeof(struct input), BUFFER_UPLOAD, &inputs) !=
            STATUS_DONE ||
        vulkan_buffer_create(context, "outputs", CASES * sizeof(struct output), BUFFER_READBACK, &outputs) !=
            STATUS_DONE)
        return EXIT_FAILURE;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hierarchies), cmocka_unit_test(test_slack)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    for (int i = 0; i <= MOST_HOSTILE_SPHERES; ++i)
        vulkan_pass_destroy(&passes[i]);
    vulkan_buffer_destroy(context, &outputs);
    vulkan_buffer_destroy(context, &inputs);
    const bool valid = context->validation_messages == 0;
    vulkan_context_destroy(&context);
    return failed > 0 || !valid ? EXIT_FAILURE : EXIT_SUCCESS;
}
