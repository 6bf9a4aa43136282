#include "device.h"

#include <stdio.h>
#include <string.h>

#include "vulkan/probe.h"

enum { SCENE_BINDINGS = 8, INPUTS = SCENE_BINDINGS, OUTPUTS, BINDINGS };
enum { GROUP = 64 };              /* invocations, as in functions.comp */
enum { CORRECTED_DIVISION = 32 }; /* of arithmetic.glsl */
enum { SCENE_BYTES = 1024 };      /* more than one view, or three elements of any kind */

enum status device_create(struct vulkan_context *context, bool corrected, struct device *device)
{
    const VkDeviceSize size = (VkDeviceSize)BATCH * MOST_WORDS * sizeof(union word);
    *device = (struct device){.context = context};
    enum status status = probe_require_exact(context);
    device->corrected = corrected || needs_correction(&context->arithmetic);
    device->corrected_division = corrected || !context->arithmetic.division_exact;
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(context, "scene", SCENE_BYTES, BUFFER_UPLOAD, &device->scene);
    if (status == STATUS_DONE)
        memset(device->scene.mapped, 0, SCENE_BYTES);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(context, "inputs", size, BUFFER_READBACK, &device->inputs);
    if (status == STATUS_DONE)
        status = vulkan_buffer_create(context, "outputs", size, BUFFER_READBACK, &device->outputs);
    if (status != STATUS_DONE)
        device_destroy(device);
    return status;
}

void device_destroy(struct device *device)
{
    pass_frame_destroy(&device->frame);
    vulkan_pass_destroy(&device->pass);
    vulkan_buffer_destroy(device->context, &device->outputs);
    vulkan_buffer_destroy(device->context, &device->inputs);
    vulkan_buffer_destroy(device->context, &device->scene);
    *device = (struct device){0};
}

/* What the build made of functions.comp for this function; at most `room` words. Returns their number, or 0.
 */
static size_t read_spirv(const struct device *device, const char *function, uint32_t *words, size_t room)
{
    char path[4096];
    snprintf(path, sizeof path, SPIRV_FOLDER "/%s%s.spv", function, device->corrected ? "_corrected" : "");
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

static void set_constant(struct pass_constant *constants, uint32_t *count, struct pass_constant constant)
{
    uint32_t i = 0;
    while (i < *count && constants[i].id != constant.id)
        ++i;
    constants[i] = constant;
    *count += i == *count;
}

enum status device_load(struct device *device, const struct function_test *test)
{
    static uint32_t words[1 << 16];
    const size_t word_count = read_spirv(device, test->function, words, sizeof words / sizeof *words);
    if (word_count == 0)
        return STATUS_UNABLE;
    struct pass_constant constants[PASS_MOST_CONSTANTS];
    uint32_t count = 0;
    for (int i = 0; i < COMMON_CONSTANTS; ++i)
        set_constant(constants, &count, common_constants[i]);
    set_constant(constants, &count, (struct pass_constant){CORRECTED_DIVISION, device->corrected_division});
    for (int i = 0; i < MOST_CONSTANTS && test->constants[i].id != 0; ++i)
        set_constant(constants, &count, test->constants[i]);
    VkDescriptorType bindings[BINDINGS];
    VkDescriptorBufferInfo buffers[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; ++i) {
        bindings[i] =
            i < SCENE_BINDINGS ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        buffers[i] = (VkDescriptorBufferInfo){i == INPUTS    ? device->inputs.buffer
                                              : i == OUTPUTS ? device->outputs.buffer
                                                             : device->scene.buffer,
                                              0, VK_WHOLE_SIZE};
    }
    pass_frame_destroy(&device->frame);
    vulkan_pass_destroy(&device->pass);
    enum status status = vulkan_pass_create(device->context,
                                            &(struct pass_info){
                                                .name = test->name,
                                                .code = {words, word_count * sizeof *words},
                                                .constants = constants,
                                                .constant_count = count,
                                                .bindings = bindings,
                                                .binding_count = BINDINGS,
                                            },
                                            &device->pass);
    return status == STATUS_DONE ? pass_frame_create(&device->pass, buffers, NULL, &device->frame) : status;
}

enum status device_run(struct device *device, size_t count, double *ns)
{
    const struct pass_dispatch dispatch = {.groups_x = (uint32_t)(count + GROUP - 1) / GROUP, .groups_y = 1};
    double milliseconds = 0;
    enum status status = pass_frame_submit(&device->frame, &dispatch);
    if (status == STATUS_DONE)
        status = pass_frame_wait(&device->frame, &milliseconds);
    *ns = milliseconds * 1e6;
    return status;
}
