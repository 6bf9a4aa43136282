#ifndef VKWHITTED_BENCH_TABLE_H
#define VKWHITTED_BENCH_TABLE_H

#include <jansson.h>
#include <stdio.h>

#include "base/status.h"

/* A scene of the bench document for people: a line a setting, then the fitted slopes, what device and
 * reference agree in, and a recommendation for each of four errors. */
void bench_print_scene(const json_t *scene, FILE *stream);

/* All points of all scenes of the document, one a line under a line of names (RFC 4180). The file appears
 * whole or not at all. */
enum status bench_csv_write(const json_t *document, const char *path);

#endif
