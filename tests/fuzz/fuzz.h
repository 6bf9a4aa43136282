#ifndef VKWHITTED_FUZZ_H
#define VKWHITTED_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* A fuzz target, as libFuzzer has it: takes any bytes, and aborts where a promise is broken. It keeps nothing
 * from one input to the next. Its messages on standard error are not shown. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
