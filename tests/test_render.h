#ifndef VKWHITTED_TEST_RENDER_H
#define VKWHITTED_TEST_RENDER_H

/* Scenes to packed scenes to pictures, for tests that look at values. Include after cmocka.h. */

#include <string.h>

#include "scene/pack.h"
#include "scene/scene.h"
#include "tracer/render.h"
#include "vulkan/context.h"

static struct vulkan_context *test_context;

static inline int test_open_device(void **state)
{
    (void)state;
    return vulkan_context_create(&(struct vulkan_options){0}, &test_context) == STATUS_DONE ? 0 : -1;
}

static inline int test_close_device(void **state)
{
    (void)state;
    return vulkan_context_destroy(&test_context) == STATUS_DONE ? 0 : -1;
}

/* The beginning of a scene file, behind which there may be more materials. */
#define TEST_SCENE_HEAD                                                                                      \
    "camera: { position: [0, 2, -6], look_at: [0, 2, 0] }\n"                                                 \
    "image: { width: 60, height: 40 }\n"                                                                     \
    "materials:\n"                                                                                           \
    "  - { name: Matte, type: matte, color: [0.5, 0.5, 0.5], roughness: 0.6 }\n"                             \
    "  - { name: Mirror, type: mirror }\n"                                                                   \
    "  - { name: Glass, type: transparent, ior: 1.5 }\n"

/* The scene's own settings. */
static inline struct picture_settings test_settings(const struct scene *scene)
{
    return (struct picture_settings){
        .width = scene->width,
        .height = scene->height,
        .max_bounces = scene->max_bounces,
        .samples = 1,
        .light_samples = scene->light_samples,
    };
}

static inline struct packed_scene test_pack(const struct scene *scene, struct picture_settings settings)
{
    struct packed_scene packed;
    assert_int_equal(pack_scene(NULL, scene, &settings, &packed), STATUS_DONE);
    return packed;
}

/* name is relative to the source folder. */
static inline struct scene test_read(const char *name)
{
    char path[512];
    struct scene scene;
    snprintf(path, sizeof path, "%s/%s", SOURCE_DIR, name);
    assert_int_equal(scene_read(path, &scene), STATUS_DONE);
    return scene;
}

enum test_renderer { TEST_DEVICE, TEST_FLOAT, TEST_DOUBLE, TEST_QUAD, TEST_RENDERERS };

static const char *const test_renderer_names[TEST_RENDERERS] = {"device", "float", "double", "quad"};

/* Renders the window (whole picture: width 0); the caller frees .image. Rays are counted. */
static inline struct rendering test_render(const struct packed_scene *packed, enum test_renderer renderer,
                                           struct window window)
{
    struct rendering rendering;
    if (window.width == 0)
        window = (struct window){0, 0, (unsigned)packed->width, (unsigned)packed->height};
    struct render_plan plan = {.scene = packed, .window = window, .count_rays = true, .quiet = true};
    if (renderer == TEST_DEVICE) {
        assert_int_equal(render_on_device(test_context, &plan, &rendering), STATUS_DONE);
    } else {
        plan.precision = (enum precision)(renderer - TEST_FLOAT);
        assert_int_equal(render_on_cpu(&plan, &rendering), STATUS_DONE);
    }
    return rendering;
}

static inline struct rendering test_render_scene(const struct scene *scene, enum test_renderer renderer,
                                                 struct window window)
{
    struct packed_scene packed = test_pack(scene, test_settings(scene));
    struct rendering rendering = test_render(&packed, renderer, window);
    pack_destroy(&packed);
    return rendering;
}

#endif
