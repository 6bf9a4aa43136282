#ifndef VKWHITTED_WATCH_GLSLANG_COMPILE_H
#define VKWHITTED_WATCH_GLSLANG_COMPILE_H

#include <stdint.h>

enum { GLSLANG_MOST_SOURCE = 16 << 20, GLSLANG_MOST_WORDS = 1 << 22, GLSLANG_MOST_LOG = 1 << 16 };

/* A compilation in memory that processes share. */
struct glslang_job {
    char defines[256];
    char source[GLSLANG_MOST_SOURCE]; /* ends with 0; #include is not known */
    char log[GLSLANG_MOST_LOG];       /* what glslang says of it */
    uint32_t word_count;              /* 0: it failed */
    uint32_t words[GLSLANG_MOST_WORDS];
};

/* Initialises glslang and its tables of built-in functions, which takes 100 ms. Leaves the job's source
 * alone: it may be there already. */
void glslang_warm_up(struct glslang_job *job);

/* Keeps a compilation gone wild from taking all memory, and all time: SIGXCPU ends the process. */
enum { GLSLANG_MOST_SECONDS = 2 }; /* of processor time; it takes 0.03 */
void glslang_limit(void);

/* Compiles the source to SPIR-V, with the options that the build gives to glslangValidator. May crash. */
void glslang_run(struct glslang_job *job);

#endif
