#ifndef VKWHITTED_BENCH_REPORT_H
#define VKWHITTED_BENCH_REPORT_H

#include <jansson.h>

#include "base/status.h"

/* Writes the bench document as one HTML page that needs nothing else: charts, tables, pictures, machine. A
 * value that is missing or null shows as a dash. The file appears whole or not at all; STATUS_UNABLE has been
 * reported, also where there is no gnuplot (gnuplot_check() tells beforehand). */
enum status report_write(const json_t *document, const char *path);

/* Writes the speed-against-error chart of one scene of the document as an SVG file; the rest as above. */
enum status chart_write(const json_t *scene, const char *path);

#endif
