#ifndef VKWHITTED_IMAGE_EXR_ERROR_H
#define VKWHITTED_IMAGE_EXR_ERROR_H

#include <openexr.h>
#include <stdbool.h>

/* The first thing that OpenEXR complained of since exr_error_clear(), in this thread; "no memory" if it did
 * not. */
void exr_error_clear(void);
const char *exr_error(void);

/* For its contexts. */
void exr_error_keep(exr_const_context_t context, exr_result_t result, const char *message);

/* Whether it is; keeps it otherwise. */
bool exr_succeeded(exr_result_t result);

#endif
