#ifndef VKWHITTED_BASE_INSTALLATION_H
#define VKWHITTED_BASE_INSTALLATION_H

#include <limits.h>

/* The folder of that name (scenes, shaders) that was installed with the program, or where that is not known
 * or not there, as for a program that is not installed, the source's. */
void installation_find(const char *name, char folder[static PATH_MAX]);

#endif
