#include "vulkan/compute.h"

#include <string.h>

#include "vulkan/buffer.h"

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    struct vulkan_buffer input, output = {0};
    struct vulkan_pass pass = {0};
    struct vulkan_command command = {0};
    double unused_ms;
    enum status status = vulkan_buffer_create(context, "input", job->input_size,
                                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BUFFER_UPLOAD, &input);
    if (status == STATUS_DONE) {
        memcpy(input.mapped, job->input, job->input_size);
        status = vulkan_buffer_create(context, "output", job->output_size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                      BUFFER_READBACK, &output);
    }
    if (status == STATUS_DONE)
        status = vulkan_pass_create(
            context,
            &(struct pass_info){
                .name = "one-shot compute",
                .code = job->code,
                .constants = job->constants,
                .constant_count = job->constant_count,
                .bindings =
                    (struct pass_binding[]){
                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {input.buffer, 0, VK_WHOLE_SIZE}},
                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {output.buffer, 0, VK_WHOLE_SIZE}},
                    },
                .binding_count = 2,
            },
            &pass);
    if (status == STATUS_DONE)
        status = vulkan_command_create(context, &command);
    if (status == STATUS_DONE)
        status = vulkan_command_begin(&command, "one-shot compute");
    if (status == STATUS_DONE) {
        vulkan_pass_record(&pass, &command, NULL, job->groups, 1);
        status = vulkan_command_submit(&command);
    }
    if (status == STATUS_DONE)
        status = vulkan_command_wait(&command, &unused_ms);
    if (status == STATUS_DONE)
        memcpy(job->output, output.mapped, job->output_size);
    vulkan_command_destroy(&command);
    vulkan_pass_destroy(&pass);
    vulkan_buffer_destroy(context, &output);
    vulkan_buffer_destroy(context, &input);
    return status;
}
