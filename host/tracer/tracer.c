#include "tracer/tracer_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "vulkan/debug.h"
#include "vulkan/pipeline.h"
#include "vulkan/probe.h"

static enum status create_picture(struct tracer *tracer)
{
    VkDeviceSize size = (VkDeviceSize)tracer->tile_pixels * pixel_size(tracer);
    const VkMemoryPropertyFlags readable = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT |
                                           VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    enum status status = vulkan_buffer_create(
        tracer->context, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
        (VkMemoryPropertyFlags[]){VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | readable,
                                  VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0},
        &tracer->picture);
    for (int i = PICTURE; i < EVENTS; ++i) /* the saved ones are not used until the tracer is resumable */
        tracer->bindings[i] =
            (VkDescriptorBufferInfo){.buffer = tracer->picture.buffer, .range = VK_WHOLE_SIZE};
    if (status != STATUS_DONE || (tracer->picture.properties & readable) == readable)
        return status;
    return vulkan_buffer_create(
        tracer->context, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        (VkMemoryPropertyFlags[]){
            readable, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, 0},
        &tracer->staging);
}

/* The variant of the shader that suits the device and what is asked for. */
static enum whitted_variant choose_variant(const struct arithmetic *arithmetic,
                                           const struct tracer_options *options)
{
    bool native = arithmetic->division_exact && arithmetic->root_exact;
    bool events = options->event_room > 0;
    if (options->double_precision)
        return events ? WHITTED_DOUBLE_EVENTS : WHITTED_DOUBLE;
    if (options->fast)
        return WHITTED_FAST;
    if (native)
        return events ? WHITTED_EXACT_EVENTS : WHITTED_EXACT;
    return events ? WHITTED_CORRECTED_EVENTS : WHITTED_CORRECTED;
}

struct shader_choice tracer_shader(const struct vulkan_context *context, const struct packed_scene *scene,
                                   const struct tracer_options *options)
{
    struct shader_choice choice = {choose_variant(&context->arithmetic, options),
                                   tracer_scene_needs_storage(context, scene)};
    return choice;
}

static struct specialization constants_of(const struct tracer *tracer, const struct packed_scene *scene)
{
    const struct arithmetic *arithmetic = &tracer->context->arithmetic;
    struct specialization constants = specialize(scene, &tracer->shape, tracer->options.output);
    constants.corrected_division = !arithmetic->division_exact;
    constants.corrected_root = !arithmetic->root_exact;
    /* lavapipe's limit is 65535; what is left is for loops of the driver's own making */
    constants.turn_limit =
        tracer->context->driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE ? 65000 : UINT32_MAX;
    constants.resumable = tracer->resumable;
    return constants;
}

enum status tracer_build_pipeline(struct tracer *tracer)
{
    const struct tracer_options *options = &tracer->options;
    const struct shader_choice choice = tracer_shader(tracer->context, tracer->packed, options);
    const struct spirv code =
        options->code.words ? options->code : whitted_spirv(choice.variant, choice.scene_in_storage);
    const struct specialization constants = constants_of(tracer, tracer->packed);
    double start = clock_ms();
    enum status status =
        vulkan_pipeline_create(tracer->context, code, tracer->pipeline_layout, (const uint32_t *)&constants,
                               sizeof constants / sizeof(uint32_t), &tracer->pipeline);
    vulkan_name(tracer->context, VK_OBJECT_TYPE_PIPELINE, (uint64_t)tracer->pipeline, "whitted.comp");
    log_info("pipeline built in %.1f ms", clock_ms() - start);
    return status;
}

static VkDescriptorType binding_type(const struct tracer *tracer, uint32_t binding)
{
    return is_storage_buffer(binding, tracer->scene_in_storage) ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                                : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

static uint32_t binding_count(const struct tracer *tracer)
{
    return tracer->events.buffer ? BINDINGS : EVENTS;
}

static void write_bindings(const struct tracer *tracer)
{
    for (uint32_t i = 0; i < binding_count(tracer); ++i)
        vkUpdateDescriptorSets(tracer->context->device, 1,
                               &(VkWriteDescriptorSet){
                                   .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = tracer->set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = binding_type(tracer, i),
                                   .pBufferInfo = &tracer->bindings[i],
                               },
                               0, NULL);
}

bool tracer_update(struct tracer *tracer, const struct packed_scene *scene)
{
    const struct specialization built = constants_of(tracer, tracer->packed);
    const struct specialization needed = constants_of(tracer, scene);
    if (memcmp(&built, &needed, sizeof built) != 0)
        return false;
    tracer_copy_scene(tracer, scene);
    tracer->packed = scene;
    tracer->picture_width = (unsigned)scene->width;
    tracer->picture_height = (unsigned)scene->height;
    return true;
}

static enum status create_layout(struct tracer *tracer)
{
    const VkDevice device = tracer->context->device;
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < binding_count(tracer); ++i)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = binding_type(tracer, i),
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VULKAN_CALL(vkCreateDescriptorSetLayout, device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = binding_count(tracer),
                    .pBindings = bindings,
                },
                NULL, &tracer->set_layout);
    VULKAN_CALL(vkCreatePipelineLayout, device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &tracer->set_layout,
                    .pushConstantRangeCount = 1,
                    .pPushConstantRanges =
                        &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct push_constants)},
                },
                NULL, &tracer->pipeline_layout);
    VULKAN_CALL(vkCreateDescriptorPool, device,
                &(VkDescriptorPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                    .maxSets = 1,
                    .poolSizeCount = 2,
                    .pPoolSizes = (VkDescriptorPoolSize[]){{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, BINDINGS},
                                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDINGS}},
                },
                NULL, &tracer->descriptor_pool);
    VULKAN_CALL(vkAllocateDescriptorSets, device,
                &(VkDescriptorSetAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                    .descriptorPool = tracer->descriptor_pool,
                    .descriptorSetCount = 1,
                    .pSetLayouts = &tracer->set_layout,
                },
                &tracer->set);
    write_bindings(tracer);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status tracer_become_resumable(struct tracer *tracer)
{
    /* of SavedPixel and SavedPath in resume.glsl, in double; float takes less */
    enum { SAVED_PIXEL_BYTES = 224, SAVED_PATH_BYTES = 64, MOST_BYTES = 1 << 26, MOST_PIXELS = 4096 };
    unsigned stack_room = tracer->packed->max_bounces > 0 ? (unsigned)tracer->packed->max_bounces : 1;
    unsigned pixels = MOST_BYTES / (SAVED_PATH_BYTES * stack_room);
    pixels = pixels < MOST_PIXELS ? pixels : MOST_PIXELS;
    tracer->resumable = true;
    tracer->tile_pixels = tracer->tile_pixels < pixels ? tracer->tile_pixels : pixels;
    tracer->shape.rows = 1;
    tracer->samples_per_dispatch = 1;
    vkDestroyPipeline(tracer->context->device, tracer->pipeline, NULL);
    tracer->pipeline = VK_NULL_HANDLE;
    const VkMemoryPropertyFlags kinds[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    enum status status =
        vulkan_buffer_create(tracer->context, (VkDeviceSize)tracer->tile_pixels * SAVED_PIXEL_BYTES,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, kinds, &tracer->saved_pixels);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(tracer->context,
                                      (VkDeviceSize)tracer->tile_pixels * stack_room * SAVED_PATH_BYTES,
                                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, kinds, &tracer->saved_stacks);
    if (status != STATUS_DONE)
        return status;
    tracer->bindings[SAVED_PIXELS].buffer = tracer->saved_pixels.buffer;
    tracer->bindings[SAVED_STACKS].buffer = tracer->saved_stacks.buffer;
    write_bindings(tracer);
    return tracer_build_pipeline(tracer);
}

static enum status create_commands(struct tracer *tracer)
{
    const VkDevice device = tracer->context->device;
    VULKAN_CALL(vkCreateCommandPool, device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                    .queueFamilyIndex = tracer->context->queue_family,
                },
                NULL, &tracer->command_pool);
    VULKAN_CALL(vkAllocateCommandBuffers, device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = tracer->command_pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &tracer->commands);
    if (tracer->context->timestamp_bits > 0)
        VULKAN_CALL(vkCreateQueryPool, device,
                    &(VkQueryPoolCreateInfo){
                        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                        .queryCount = 2,
                    },
                    NULL, &tracer->timestamps);
    VULKAN_CALL(vkCreateFence, device, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                NULL, &tracer->fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

/* A dispatch should end well within a second, so that Ctrl-C is heard and no watchdog bites. */
static unsigned choose_tile_pixels(const struct vulkan_context *context, const struct packed_scene *scene,
                                   unsigned samples)
{
    uint64_t work_per_pixel =
        samples * (1 + (uint64_t)scene->light_samples * (uint64_t)scene->quad_light_count);
    uint64_t pixels = (UINT64_C(1) << 22) / work_per_pixel;
    uint64_t fitting = context->properties.limits.maxStorageBufferRange / (CHANNELS * sizeof(double));
    pixels = pixels < 1024 ? 1024 : pixels;
    pixels = pixels > 1 << 21 ? 1 << 21 : pixels;
    return (unsigned)(pixels < fitting ? pixels : fitting);
}

/* So many that an invocation's loops stay well below lavapipe's limit, as far as can be told beforehand: as
 * resume.glsl counts them, with 16 rays and as many leaves where there are secondary rays. */
static unsigned choose_samples_per_dispatch(const struct packed_scene *scene, const struct group_shape *shape)
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

static void name_objects(const struct tracer *tracer)
{
    struct vulkan_context *context = tracer->context;
    vulkan_name(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)tracer->scene.buffer, "scene");
    vulkan_name(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)tracer->picture.buffer, "tile of the picture");
    vulkan_name(context, VK_OBJECT_TYPE_BUFFER, (uint64_t)tracer->staging.buffer, "tile for the host");
    vulkan_name(context, VK_OBJECT_TYPE_DESCRIPTOR_SET, (uint64_t)tracer->set, "scene and picture");
    vulkan_name(context, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)tracer->commands, "tracer");
}

enum status tracer_create(struct vulkan_context *context, const struct packed_scene *scene,
                          const struct tracer_options *options, struct tracer **pointer)
{
    struct tracer *tracer = *pointer = calloc(1, sizeof *tracer);
    if (!tracer) {
        log_error("no memory for the tracer");
        return STATUS_UNABLE;
    }
    tracer->context = context;
    tracer->double_precision = options->double_precision;
    /* A processor's lanes share the loading of the scene over many pixels; a GPU wants many invocations. */
    bool on_processor = context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    tracer->shape.rows = on_processor ? 16 : 1;
    tracer->shape.width = options->group_width ? options->group_width : 8;
    tracer->shape.height = options->group_height ? options->group_height : on_processor ? 1 : 8;
    tracer->samples_per_dispatch = choose_samples_per_dispatch(scene, &tracer->shape);
    tracer->tile_pixels = options->tile_pixels
                              ? options->tile_pixels
                              : choose_tile_pixels(context, scene, tracer->samples_per_dispatch);
    tracer->packed = scene;
    tracer->options = *options;
    tracer->picture_width = (unsigned)scene->width;
    tracer->picture_height = (unsigned)scene->height;
    enum status status = options->fast ? STATUS_DONE : probe_require_exact(context);
    if (status == STATUS_DONE && options->double_precision && !context->has_float64) {
        log_error("%s has no double precision (shaderFloat64)", context->properties.deviceName);
        status = STATUS_UNABLE;
    }
    if (status == STATUS_DONE) {
        tracer->scene_in_storage = tracer_shader(context, scene, options).scene_in_storage;
        status = tracer_upload_scene(tracer, scene);
    }
    if (status == STATUS_DONE)
        status = create_picture(tracer);
    if (status == STATUS_DONE)
        status = tracer_create_events(tracer);
    if (status == STATUS_DONE)
        status = create_layout(tracer);
    if (status == STATUS_DONE)
        status = tracer_build_pipeline(tracer);
    if (status == STATUS_DONE)
        status = create_commands(tracer);
    if (status == STATUS_DONE)
        name_objects(tracer);
    else
        tracer_destroy(pointer);
    return status;
}

void tracer_destroy(struct tracer **pointer)
{
    struct tracer *tracer = *pointer;
    *pointer = NULL;
    if (!tracer)
        return;
    const VkDevice device = tracer->context->device;
    vkDestroyFence(device, tracer->fence, NULL);
    vkDestroyQueryPool(device, tracer->timestamps, NULL);
    vkDestroyCommandPool(device, tracer->command_pool, NULL);
    vkDestroyPipeline(device, tracer->pipeline, NULL);
    vkDestroyDescriptorPool(device, tracer->descriptor_pool, NULL);
    vkDestroyPipelineLayout(device, tracer->pipeline_layout, NULL);
    vkDestroyDescriptorSetLayout(device, tracer->set_layout, NULL);
    vulkan_buffer_destroy(tracer->context, &tracer->saved_stacks);
    vulkan_buffer_destroy(tracer->context, &tracer->saved_pixels);
    vulkan_buffer_destroy(tracer->context, &tracer->events);
    vulkan_buffer_destroy(tracer->context, &tracer->staging);
    vulkan_buffer_destroy(tracer->context, &tracer->picture);
    vulkan_buffer_destroy(tracer->context, &tracer->scene);
    free(tracer);
}
