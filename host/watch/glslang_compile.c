#include "watch/glslang_compile.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static glslang_input_t input_of(const char *source)
{
    return (glslang_input_t){
        .language = GLSLANG_SOURCE_GLSL,
        .stage = GLSLANG_STAGE_COMPUTE,
        .client = GLSLANG_CLIENT_VULKAN,
        .client_version = GLSLANG_TARGET_VULKAN_1_2,
        .target_language = GLSLANG_TARGET_SPV,
        .target_language_version = GLSLANG_TARGET_SPV_1_5,
        .code = source,
        .default_version = 100,
        .default_profile = GLSLANG_NO_PROFILE,
        .messages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT |
                    (SHADER_DEBUG_INFO ? GLSLANG_MSG_DEBUG_INFO_BIT : 0),
        .resource = glslang_default_resource(),
    };
}

static void append(struct glslang_job *job, const char *text)
{
    size_t length = strlen(job->log);
    if (text)
        snprintf(job->log + length, sizeof job->log - length, "%s", text);
}

static void link_and_generate(struct glslang_job *job, glslang_shader_t *shader, const glslang_input_t *input)
{
    glslang_program_t *program = glslang_program_create();
    glslang_program_add_shader(program, shader);
    bool linked = glslang_program_link(program, (int)input->messages) && glslang_program_map_io(program);
    append(job, glslang_program_get_info_log(program));
    if (linked) {
        glslang_spv_options_t options = {
            .generate_debug_info = SHADER_DEBUG_INFO,
            .disable_optimizer = true,
            .validate = true,
        };
        glslang_program_add_source_text(program, GLSLANG_STAGE_COMPUTE, input->code, strlen(input->code));
        glslang_program_set_source_file(program, GLSLANG_STAGE_COMPUTE, "whitted.comp");
        glslang_program_SPIRV_generate_with_options(program, GLSLANG_STAGE_COMPUTE, &options);
        append(job, glslang_program_SPIRV_get_messages(program));
        size_t count = glslang_program_SPIRV_get_size(program);
        if (count <= GLSLANG_MOST_WORDS) {
            glslang_program_SPIRV_get(program, job->words);
            job->word_count = (uint32_t)count;
        }
    }
    glslang_program_delete(program);
}

static void compile(const char *source, const char *defines, struct glslang_job *job)
{
    const glslang_input_t input = input_of(source);
    job->log[0] = 0;
    job->word_count = 0;
    glslang_shader_t *shader = glslang_shader_create(&input);
    glslang_shader_set_preamble(shader, defines);
    bool parsed = glslang_shader_preprocess(shader, &input) && glslang_shader_parse(shader, &input);
    append(job, glslang_shader_get_info_log(shader));
    if (parsed)
        link_and_generate(job, shader, &input);
    glslang_shader_delete(shader);
}

void glslang_run(struct glslang_job *job)
{
    compile(job->source, job->defines, job);
}

void glslang_warm_up(struct glslang_job *job)
{
    glslang_initialize_process();
    compile("#version 460\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "", job);
}

void glslang_limit(void)
{
    setrlimit(RLIMIT_CPU, &(struct rlimit){GLSLANG_MOST_SECONDS, GLSLANG_MOST_SECONDS + 1});
#ifndef __SANITIZE_ADDRESS__ /* which reserves terabytes of addresses */
    setrlimit(RLIMIT_AS, &(struct rlimit){.rlim_cur = 1 << 30, .rlim_max = 1 << 30});
#endif
    setrlimit(RLIMIT_CORE, &(struct rlimit){0});
}
