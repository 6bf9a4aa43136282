#include "device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "vulkan/probe.h"

enum { VIEW, SCENE_BINDINGS = 5, INPUTS = SCENE_BINDINGS, OUTPUTS, BINDINGS };
enum { GROUP = 64 }; /* invocations, as in functions.comp */
enum { CORRECTED_DIVISION = 22, CORRECTED_ROOT };
enum { INPUT_WORDS = 100, OUTPUT_WORDS }; /* constants of functions.comp */
enum { SCENE_BYTES = 1024 };              /* more than one view, or three elements of any kind */

static enum status create_buffers(struct device *device)
{
    const VkMemoryPropertyFlags coherent =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkDeviceSize size = (VkDeviceSize)BATCH * MOST_WORDS * sizeof(union word);
    enum status status =
        vulkan_buffer_create(device->context, SCENE_BYTES, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                             (VkMemoryPropertyFlags[]){coherent, 0}, &device->scene);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(
            device->context, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            (VkMemoryPropertyFlags[]){VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | coherent, coherent, 0},
            &device->inputs);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(
            device->context, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            (VkMemoryPropertyFlags[]){coherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, coherent, 0},
            &device->outputs);
    if (status == STATUS_DONE)
        memset(device->scene.mapped, 0, SCENE_BYTES);
    return status;
}

static VkDescriptorType descriptor_type(uint32_t binding)
{
    return binding < SCENE_BINDINGS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static enum status create_set(struct device *device)
{
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = descriptor_type(i),
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VULKAN_CALL(vkCreateDescriptorSetLayout, device->context->device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = BINDINGS,
                    .pBindings = bindings,
                },
                NULL, &device->set_layout);
    VULKAN_CALL(vkCreatePipelineLayout, device->context->device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &device->set_layout,
                },
                NULL, &device->pipeline_layout);
    VULKAN_CALL(vkCreateDescriptorPool, device->context->device,
                &(VkDescriptorPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                    .maxSets = 1,
                    .poolSizeCount = 2,
                    .pPoolSizes = (VkDescriptorPoolSize[]){{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, BINDINGS},
                                                           {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDINGS}},
                },
                NULL, &device->descriptor_pool);
    VULKAN_CALL(vkAllocateDescriptorSets, device->context->device,
                &(VkDescriptorSetAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                    .descriptorPool = device->descriptor_pool,
                    .descriptorSetCount = 1,
                    .pSetLayouts = &device->set_layout,
                },
                &device->set);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

static void bind_buffers(struct device *device)
{
    for (uint32_t i = 0; i < BINDINGS; ++i)
        vkUpdateDescriptorSets(device->context->device, 1,
                               &(VkWriteDescriptorSet){
                                   .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = device->set,
                                   .dstBinding = i,
                                   .descriptorCount = 1,
                                   .descriptorType = descriptor_type(i),
                                   .pBufferInfo =
                                       &(VkDescriptorBufferInfo){
                                           .buffer = i == INPUTS    ? device->inputs.buffer
                                                     : i == OUTPUTS ? device->outputs.buffer
                                                                    : device->scene.buffer,
                                           .range = VK_WHOLE_SIZE,
                                       },
                               },
                               0, NULL);
}

static enum status create_commands(struct device *device)
{
    VULKAN_CALL(vkCreateCommandPool, device->context->device,
                &(VkCommandPoolCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                    .queueFamilyIndex = device->context->queue_family,
                },
                NULL, &device->command_pool);
    VULKAN_CALL(vkAllocateCommandBuffers, device->context->device,
                &(VkCommandBufferAllocateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                    .commandPool = device->command_pool,
                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                    .commandBufferCount = 1,
                },
                &device->commands);
    if (device->context->timestamp_bits > 0)
        VULKAN_CALL(vkCreateQueryPool, device->context->device,
                    &(VkQueryPoolCreateInfo){
                        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                        .queryCount = 2,
                    },
                    NULL, &device->timestamps);
    VULKAN_CALL(vkCreateFence, device->context->device,
                &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO}, NULL, &device->fence);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status device_create(struct vulkan_context *context, bool corrected, struct device *device)
{
    *device = (struct device){.context = context};
    enum status status = probe_require_exact(context);
    device->corrected_division = corrected || !context->arithmetic.division_exact;
    device->corrected_root = corrected || !context->arithmetic.root_exact;
    if (status == STATUS_DONE)
        status = create_buffers(device);
    if (status == STATUS_DONE)
        status = create_set(device);
    if (status == STATUS_DONE)
        bind_buffers(device);
    if (status == STATUS_DONE)
        status = create_commands(device);
    if (status != STATUS_DONE)
        device_destroy(device);
    return status;
}

void device_destroy(struct device *device)
{
    const VkDevice handle = device->context->device;
    vkDestroyFence(handle, device->fence, NULL);
    vkDestroyQueryPool(handle, device->timestamps, NULL);
    vkDestroyCommandPool(handle, device->command_pool, NULL);
    vkDestroyPipeline(handle, device->pipeline, NULL);
    vkDestroyDescriptorPool(handle, device->descriptor_pool, NULL);
    vkDestroyPipelineLayout(handle, device->pipeline_layout, NULL);
    vkDestroyDescriptorSetLayout(handle, device->set_layout, NULL);
    vulkan_buffer_destroy(device->context, &device->outputs);
    vulkan_buffer_destroy(device->context, &device->inputs);
    vulkan_buffer_destroy(device->context, &device->scene);
    *device = (struct device){0};
}

/* What the build made of functions.comp for this function; at most `room` words. Returns their number, or 0.
 */
static size_t read_spirv(const struct device *device, const char *function, uint32_t *words, size_t room)
{
    bool native = !device->corrected_division && !device->corrected_root;
    char path[4096];
    snprintf(path, sizeof path, SPIRV_FOLDER "/%s%s.spv", function, native ? "" : "_corrected");
    FILE *file = fopen(path, "rb");
    size_t count = file ? fread(words, sizeof *words, room, file) : 0;
    if (count == 0 || count == room) {
        log_error("%s: %s", path, count == 0 ? "cannot be read" : "too long");
        count = 0;
    }
    if (file)
        fclose(file);
    return count;
}

static enum status create_pipeline(struct device *device, const char *function,
                                   const VkSpecializationInfo *constants)
{
    static uint32_t words[1 << 16];
    const size_t count = read_spirv(device, function, words, sizeof words / sizeof *words);
    VkShaderModule module = VK_NULL_HANDLE;
    if (count == 0)
        return STATUS_UNABLE;
    VULKAN_CALL(vkCreateShaderModule, device->context->device,
                &(VkShaderModuleCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                    .codeSize = count * sizeof *words,
                    .pCode = words,
                },
                NULL, &module);
    VULKAN_CALL(vkCreateComputePipelines, device->context->device, VK_NULL_HANDLE, 1,
                &(VkComputePipelineCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                    .stage =
                        {
                            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                            .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                            .module = module,
                            .pName = "main",
                            .pSpecializationInfo = constants,
                        },
                    .layout = device->pipeline_layout,
                },
                NULL, &device->pipeline);
    vkDestroyShaderModule(device->context->device, module, NULL);
    return STATUS_DONE;

error:
    vkDestroyShaderModule(device->context->device, module, NULL);
    return STATUS_UNABLE;
}

static void set_constant(struct constant *constants, uint32_t *count, struct constant constant)
{
    uint32_t i = 0;
    while (i < *count && constants[i].id != constant.id)
        ++i;
    constants[i] = constant;
    *count += i == *count;
}

enum status device_load(struct device *device, const struct function_test *test, size_t input_words,
                        size_t output_words)
{
    struct constant constants[COMMON_CONSTANTS + 4 + MOST_CONSTANTS];
    VkSpecializationMapEntry entries[sizeof constants / sizeof *constants];
    uint32_t count = 0;
    for (int i = 0; i < COMMON_CONSTANTS; ++i)
        set_constant(constants, &count, common_constants[i]);
    set_constant(constants, &count, (struct constant){CORRECTED_DIVISION, device->corrected_division});
    set_constant(constants, &count, (struct constant){CORRECTED_ROOT, device->corrected_root});
    set_constant(constants, &count, (struct constant){INPUT_WORDS, (uint32_t)input_words});
    set_constant(constants, &count, (struct constant){OUTPUT_WORDS, (uint32_t)output_words});
    for (int i = 0; i < MOST_CONSTANTS && test->constants[i].id != 0; ++i)
        set_constant(constants, &count, test->constants[i]);
    for (uint32_t i = 0; i < count; ++i)
        entries[i] = (VkSpecializationMapEntry){
            .constantID = constants[i].id,
            .offset = (uint32_t)(i * sizeof *constants + offsetof(struct constant, value)),
            .size = sizeof constants->value,
        };
    vkDestroyPipeline(device->context->device, device->pipeline, NULL);
    device->pipeline = VK_NULL_HANDLE;
    return create_pipeline(device, test->function,
                           &(VkSpecializationInfo){
                               .mapEntryCount = count,
                               .pMapEntries = entries,
                               .dataSize = count * sizeof *constants,
                               .pData = constants,
                           });
}

static enum status record(struct device *device, size_t count)
{
    const VkCommandBuffer commands = device->commands;
    VULKAN_CALL(vkBeginCommandBuffer, commands,
                &(VkCommandBufferBeginInfo){
                    .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                    .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                });
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, device->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, device->pipeline_layout, 0, 1,
                            &device->set, 0, NULL);
    if (device->timestamps) {
        vkCmdResetQueryPool(commands, device->timestamps, 0, 2);
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, device->timestamps, 0);
    }
    vkCmdDispatch(commands, (uint32_t)(count + GROUP - 1) / GROUP, 1, 1);
    if (device->timestamps)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, device->timestamps, 1);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &(VkMemoryBarrier){
                             .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                             .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                             .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
                         },
                         0, NULL, 0, NULL);
    VULKAN_CALL(vkEndCommandBuffer, commands);
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}

enum status device_run(struct device *device, size_t count, double *ns)
{
    const VkDevice handle = device->context->device;
    enum status status = record(device, count);
    if (status != STATUS_DONE)
        return status;
    double start = clock_ms();
    VULKAN_CALL(vkQueueSubmit, device->context->queue, 1,
                &(VkSubmitInfo){
                    .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                    .commandBufferCount = 1,
                    .pCommandBuffers = &device->commands,
                },
                device->fence);
    VULKAN_CALL(vkWaitForFences, handle, 1, &device->fence, VK_TRUE, UINT64_MAX);
    VULKAN_CALL(vkResetFences, handle, 1, &device->fence);
    *ns = (clock_ms() - start) * 1e6;
    if (device->timestamps) {
        uint64_t ticks[2];
        VULKAN_CALL(vkGetQueryPoolResults, handle, device->timestamps, 0, 2, sizeof ticks, ticks,
                    sizeof *ticks, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        uint64_t mask = UINT64_MAX >> (64 - device->context->timestamp_bits);
        *ns = (double)((ticks[1] - ticks[0]) & mask) *
              (double)device->context->properties.limits.timestampPeriod;
    }
    return STATUS_DONE;

error:
    return STATUS_UNABLE;
}
