#ifndef VKWHITTED_VULKAN_ARITHMETIC_H
#define VKWHITTED_VULKAN_ARITHMETIC_H

#include <stdbool.h>

enum denormals { DENORMALS_KEPT, DENORMALS_FLUSHED, DENORMALS_MIXED };
enum fused { FUSED_ALWAYS, FUSED_NEVER, FUSED_MIXED };

/* What single-precision arithmetic on a device was found to do with normal numbers; see probe.h. */
struct arithmetic {
    bool known;          /* probed */
    bool basics_exact;   /* + - * are correctly rounded, and `precise` keeps them from being contracted */
    bool division_exact; /* so is / */
    bool root_exact;     /* so is sqrt */
    enum denormals denormals; /* as results */
    enum fused fma;
    char flaw[160]; /* where the basics are not exact: an example */
};

#endif
