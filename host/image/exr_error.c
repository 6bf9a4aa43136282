#include "image/exr_error.h"

#include <stdio.h>

/* OpenEXR's error callback gets no user data where it has no context yet. */
static _Thread_local char problem[256];

void exr_error_clear(void)
{
    problem[0] = '\0';
}

const char *exr_error(void)
{
    return problem[0] ? problem : "no memory";
}

void exr_error_keep(exr_const_context_t context, exr_result_t result, const char *message)
{
    (void)context;
    if (problem[0] == '\0')
        snprintf(problem, sizeof problem, "%s", message ? message : exr_get_default_error_message(result));
}

bool exr_succeeded(exr_result_t result)
{
    if (result != EXR_ERR_SUCCESS)
        exr_error_keep(NULL, result, NULL);
    return result == EXR_ERR_SUCCESS;
}
