#ifndef VKWHITTED_FAILING_MEMORY_H
#define VKWHITTED_FAILING_MEMORY_H

#include <stddef.h>

/* With the linker's --wrap=calloc,--wrap=malloc the code under test, but not its libraries, has these called.
 * The call that is so many calls away fails. */
static int calls_to_failure = -1;
void *__real_calloc(size_t count, size_t size);
void *__real_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_malloc(size_t size);

void *__wrap_calloc(size_t count, size_t size)
{
    return calls_to_failure-- == 0 ? NULL : __real_calloc(count, size);
}

void *__wrap_malloc(size_t size)
{
    return calls_to_failure-- == 0 ? NULL : __real_malloc(size);
}

#endif
