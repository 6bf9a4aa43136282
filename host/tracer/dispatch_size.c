#include "tracer/dispatch_size.h"

#include <unistd.h>

#include "scene/body.h"

/* Turns of loops, those over objects and lights included, that an invocation may make with primary rays, and
 * again with the others, which may also have what the former leave. Lavapipe ends all loops of an invocation
 * after 65535 turns, without a word; a graphics card's watchdog bites after some seconds. */
enum { MOST_TURNS = 30000 };

static uint64_t at_least_1(uint64_t x)
{
    return x > 1 ? x : 1;
}

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static bool has_kind(const struct packed_scene *scene, int kind)
{
    bool found = false;
    for (int i = 0; i < packed_surface_count(scene); ++i)
        found = found || packed_surface(scene, i)->tags.SURFACE_KIND == kind;
    return found;
}

/* The most rays that a sample may have: of a binary tree, where there is glass. */
static uint64_t most_rays(const struct packed_scene *scene)
{
    uint64_t bounces = (uint64_t)scene->max_bounces, rays = 1;
    if (has_kind(scene, KIND_TRANSPARENT))
        rays = (UINT64_C(2) << smaller(bounces, 40)) - 1;
    else if (has_kind(scene, KIND_MIRROR))
        rays = bounces + 1;
    return rays;
}

/* Whether primary rays should have a loop of their own, before the one over rays. On a processor with long
 * vectors (lavapipe) they should, as work under a mask costs so much there; but where there are other rays it
 * is a copy of the tracer, for whose compilation (0.5 s) a picture must be large, and for which SwiftShader,
 * with vectors of 4, takes 10 s. */
static bool primary_rays_pay(const struct vulkan_context *context, const struct packed_scene *scene)
{
    const bool long_vectors =
        context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && context->subgroup_size >= 8;
    const uint64_t samples = (uint64_t)scene->width * (uint64_t)scene->height * (uint64_t)scene->samples;
    return long_vectors && (most_rays(scene) == 1 || samples >= UINT64_C(1) << 17);
}

/* Lanes of a vector may make their steps one after the other. */
static void choose_steps(const struct vulkan_context *context, struct dispatch_size *size)
{
    size->most_steps = size->on_processor ? MOST_TURNS / context->subgroup_size : MOST_TURNS;
    size->columns = size->on_processor ? 4 : 1;
}

/* Loops may be unrolled or not: all their turns are counted. A scene file has 18,000 planes at most, so that
 * one turn of the loop over rays, twice over all objects and once more where rays escape, is fewer than
 * 65535. */
static void choose_turns(const struct packed_scene *scene, bool primary_first, struct dispatch_size *size)
{
    const uint64_t objects = (uint64_t)(scene->looped_spheres + scene->plane_count);
    const uint64_t points = (uint64_t)scene->point_light_count +
                            (uint64_t)scene->quad_light_count * (uint64_t)scene->light_samples;
    const uint64_t over_objects = 2 + objects;
    const uint64_t ray = 1 + (scene->view.between_mirrors.w != 0 ? 2 : 1) * over_objects;
    const uint64_t point = 2 + over_objects;
    const uint64_t points_a_turn = ray + points * point <= MOST_TURNS
                                       ? at_least_1(points)
                                       : at_least_1((MOST_TURNS - smaller(ray, MOST_TURNS)) / point);
    const uint64_t turn = ray + points_a_turn * point;
    const uint64_t samples = (uint64_t)scene->samples;
    size->primary_rays_first = primary_first && samples * (ray + points * point) <= MOST_TURNS;
    size->light_points_a_turn = (uint32_t)points_a_turn;
    uint64_t most_turns = MOST_TURNS;
    if (size->primary_rays_first) {
        size->columns = (uint32_t)smaller(size->columns, MOST_TURNS / (samples * turn));
        most_turns += MOST_TURNS - size->columns * samples * turn;
    }
    size->most_turns = (uint32_t)at_least_1(most_turns / turn);
    const uint64_t turns_a_ray = at_least_1((points + points_a_turn - 1) / points_a_turn);
    const uint64_t turns = most_rays(scene) * turns_a_ray * samples;
    while (size->columns > 4 && turns * size->columns > size->most_turns &&
           turns * size->columns / 4 <= size->most_turns)
        size->columns /= 2; /* which costs less than to go on in the next dispatch */
    size->resumable = scene->hierarchy || turns * size->columns > size->most_turns;
}

/* The slots in which an invocation keeps its work and its stack. */
static void choose_memory(const struct packed_scene *scene, struct dispatch_size *size)
{
    const bool glass = has_kind(scene, KIND_TRANSPARENT);
    if (!size->resumable && !(glass && scene->max_bounces > MOST_IN_REGISTERS))
        return;
    const uint32_t paths = 1 + (glass ? (uint32_t)scene->max_bounces : 0); /* under way, and on the stack */
    size->saved_reals = WORK_REALS + 2 * paths;
    size->saved_words = WORK_WORDS + 2 * paths;
}

/* For the slots of a dispatch's invocations, of which two may be under way beside all that others have. */
static uint64_t most_saved_bytes(const struct vulkan_context *context)
{
    uint64_t largest_heap = 0;
    for (uint32_t i = 0; i < context->memory.memoryHeapCount; ++i)
        if (context->memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT &&
            context->memory.memoryHeaps[i].size > largest_heap)
            largest_heap = context->memory.memoryHeaps[i].size;
    return smaller(context->properties.limits.maxStorageBufferRange, largest_heap / 16);
}

/* So that a dispatch ends well within a second, and its buffers fit. A graphics card whose memory does not do
 * for so many invocations has each of them render several pixels: that is faster than more dispatches, which
 * all wait for their longest pixel. */
static void choose_tile(const struct vulkan_context *context, const struct packed_scene *scene,
                        size_t value_size, struct dispatch_size *size)
{
    enum { LEAST_PIXELS = 1024, MOST_PIXELS = 1 << 21, MOST_INVOCATIONS = 1 << 26, MOST_COLUMNS = 32 };
    const VkPhysicalDeviceLimits *limits = &context->properties.limits;
    uint64_t work_per_pixel =
        (uint64_t)scene->samples * (1 + (uint64_t)scene->light_samples * (uint64_t)scene->quad_light_count);
    uint64_t pixels = (UINT64_C(1) << (size->on_processor ? 22 : 26)) / work_per_pixel;
    pixels = pixels < LEAST_PIXELS ? LEAST_PIXELS : smaller(pixels, MOST_PIXELS);
    pixels = smaller(pixels, limits->maxStorageBufferRange / (4 * value_size));
    size->tile_pixels = (unsigned)at_least_1(pixels);
    const uint64_t saved_bytes = size->saved_reals * SAVED_REAL_BYTES * (value_size / sizeof(float));
    const uint64_t invocations = most_saved_bytes(context) / at_least_1(saved_bytes);
    const uint64_t groups = smaller(invocations, MOST_INVOCATIONS) / (size->group_width * size->group_height);
    size->tile_groups = (unsigned)at_least_1(groups - most_excess((uint32_t)groups));
    if (size->on_processor)
        return;
    pixels = smaller(pixels, (uint64_t)scene->width * (uint64_t)scene->height);
    size->columns = (uint32_t)at_least_1(smaller(pixels / at_least_1(invocations), MOST_COLUMNS));
    size->resumable = size->resumable || size->columns > 1;
}

struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene, size_t value_size)
{
    /* A processor's lanes share the loading of the scene over many pixels; a GPU wants many invocations. */
    struct dispatch_size size = {
        .on_processor = context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
        .group_width = 8,
        .group_height = 8,
        .columns = 1,
        .threads = 1,
    };
    if (size.on_processor) {
        size.group_width = context->subgroup_size >= 16 ? 16 : 8;
        size.group_height = 1;
        size.columns = 32;
        size.threads = (uint32_t)sysconf(_SC_NPROCESSORS_ONLN);
    }
    if (scene->hierarchy)
        choose_steps(context, &size);
    choose_turns(scene, !scene->hierarchy && primary_rays_pay(context, scene), &size);
    choose_memory(scene, &size);
    choose_tile(context, scene, value_size, &size);
    return size;
}
