#include "vulkan/compute.h"

#include <string.h>

#include "vulkan/buffer.h"

enum status vulkan_compute(struct vulkan_context *context, const struct compute_job *job)
{
    struct vulkan_buffer input = {0}, output = {0};
    struct vulkan_pass pass = {0};
    struct vulkan_command command = {0};
    struct pass_info info = job->pass;
    double unused_ms;
    enum status status = STATUS_UNABLE;
    if (vulkan_buffer_create(context, "input", job->input_size, BUFFER_UPLOAD, &input) != STATUS_DONE ||
        vulkan_buffer_create(context, "output", job->output_size, BUFFER_READBACK, &output) != STATUS_DONE)
        goto end;
    memcpy(input.mapped, job->input, job->input_size);
    info.bindings = (struct pass_binding[]){
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {input.buffer, 0, VK_WHOLE_SIZE}},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {output.buffer, 0, VK_WHOLE_SIZE}},
    };
    info.binding_count = 2;
    if (vulkan_pass_create(context, &info, &pass) != STATUS_DONE ||
        vulkan_command_create(context, &command) != STATUS_DONE ||
        vulkan_command_begin(&command, info.name) != STATUS_DONE)
        goto end;
    vulkan_pass_record(&pass, &command, NULL, job->groups, 1);
    status = vulkan_command_submit(&command);
    if (status == STATUS_DONE)
        status = vulkan_command_wait(&command, &unused_ms);
    if (status == STATUS_DONE)
        memcpy(job->output, output.mapped, job->output_size);

end:
    vulkan_command_destroy(&command);
    vulkan_pass_destroy(&pass);
    vulkan_buffer_destroy(context, &output);
    vulkan_buffer_destroy(context, &input);
    return status;
}
