#include "tracer/dispatch_size.h"

enum { LEAST_TILE_PIXELS = 1024, MOST_TILE_PIXELS = 1 << 21, LARGEST_PIXEL = 3 * sizeof(double) };

/* A dispatch should end well within a second, so that Ctrl-C is heard and no watchdog bites. */
static unsigned choose_tile_pixels(const struct vulkan_context *context, const struct packed_scene *scene,
                                   unsigned samples)
{
    uint64_t work_per_pixel =
        samples * (1 + (uint64_t)scene->light_samples * (uint64_t)scene->quad_light_count);
    uint64_t pixels = (UINT64_C(1) << 22) / work_per_pixel;
    uint64_t fitting = context->properties.limits.maxStorageBufferRange / LARGEST_PIXEL;
    pixels = pixels < LEAST_TILE_PIXELS ? LEAST_TILE_PIXELS : pixels;
    pixels = pixels > MOST_TILE_PIXELS ? MOST_TILE_PIXELS : pixels;
    return (unsigned)(pixels < fitting ? pixels : fitting);
}

/* So many that an invocation's loops stay well below lavapipe's limit, as far as can be told beforehand: as
 * resume.glsl counts them, with 16 rays and as many leaves where there are secondary rays. */
static unsigned choose_samples(const struct packed_scene *scene, const struct group_shape *shape)
{
    struct specialization constants = specialize(scene, shape, OUTPUT_RADIANCE);
    uint64_t objects = (uint64_t)(scene->sphere_count + scene->plane_count);
    uint64_t lights = (uint64_t)scene->point_light_count +
                      (uint64_t)scene->quad_light_count * (uint64_t)scene->light_samples;
    uint64_t rays = (constants.mirrors || constants.glass) && scene->max_bounces > 0 ? 16 : 1;
    uint64_t turns_over_objects = objects <= 8 ? 1 : 1 + objects;
    uint64_t samples = (UINT64_C(1) << 15) / (shape->rows * rays * turns_over_objects * (1 + lights));
    samples = samples < 1 ? 1 : samples;
    return (unsigned)(samples < (uint64_t)scene->samples ? samples : (uint64_t)scene->samples);
}

struct dispatch_size dispatch_size_choose(const struct vulkan_context *context,
                                          const struct packed_scene *scene)
{
    /* A processor's lanes share the loading of the scene over many pixels; a GPU wants many invocations. */
    bool on_processor = context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    struct dispatch_size size = {
        .shape = {.width = 8, .height = on_processor ? 1 : 8, .rows = on_processor ? 16 : 1},
    };
    size.samples = choose_samples(scene, &size.shape);
    size.tile_pixels = choose_tile_pixels(context, scene, size.samples);
    return size;
}

struct dispatch_size dispatch_size_resumable(struct dispatch_size size, const struct packed_scene *scene)
{
    enum { MOST_BYTES = 1 << 26, MOST_PIXELS = 4096 };
    size.stack_room = scene->max_bounces > 0 ? (unsigned)scene->max_bounces : 1;
    unsigned pixels = MOST_BYTES / (SAVED_PATH_BYTES * size.stack_room);
    pixels = pixels < MOST_PIXELS ? pixels : MOST_PIXELS;
    size.tile_pixels = size.tile_pixels < pixels ? size.tile_pixels : pixels;
    size.shape.rows = 1;
    size.samples = 1;
    return size;
}
