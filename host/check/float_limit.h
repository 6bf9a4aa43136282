#ifndef VKWHITTED_CHECK_FLOAT_LIMIT_H
#define VKWHITTED_CHECK_FLOAT_LIMIT_H

#include "tracer/job.h"

/* Warns where a job in float is for a scene that float does not resolve: where one in twenty or more of 256
 * pixels, spread over the picture, are off by 1 % or more from what double makes of the scene, with one
 * sample and few bounces and light samples. The object that most of them show is named, and what helps.
 * STATUS_UNABLE (reported) without memory. */
enum status float_limit_warn(const struct job *job);

#endif
