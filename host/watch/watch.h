#ifndef VKWHITTED_WATCH_WATCH_H
#define VKWHITTED_WATCH_WATCH_H

#include "watch/session.h"

/* Keeps the picture current while the scene file and the shader change, until Ctrl-C or the window is closed.
 */
enum status watch(const struct watch_options *options);

#endif
