#ifndef VKWHITTED_TRACER_SHADER_RULES_H
#define VKWHITTED_TRACER_SHADER_RULES_H

#include "tracer/interface.h"

/* What is wrong with a shader, and where, if that is known: the file is NULL otherwise, as in code without
 * debug information, and lies in the code. */
struct shader_problem {
    char text[160];
    const char *file;
    uint32_t line;
};

/* Whether the code, which is valid, obeys the rules of its variant. It uses no other buffers than a tracer
 * provides: drivers crash otherwise. And but for WHITTED_FAST each of its floating-point operations is one
 * that is correctly rounded (or the square root, which the probe has looked at) and carries NoContraction, so
 * that no compiler may fuse or reorder it. If not, *problem gets the first that is wrong. */
bool shader_obeys(struct spirv code, struct shader_choice choice, struct shader_problem *problem);

#endif
