#ifndef VKWHITTED_OUTPUTS_H
#define VKWHITTED_OUTPUTS_H

#include "job.h"

/* Whether the pictures of -o could be written now. */
enum status outputs_check(const struct options *options);

/* Writes the picture of the job to each file of -o, each whole or not at all. */
enum status outputs_write(const struct options *options, const struct job *job, const struct image *image,
                          const char *device);

#endif
