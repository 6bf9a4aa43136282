#ifndef VKWHITTED_BENCH_GNUPLOT_H
#define VKWHITTED_BENCH_GNUPLOT_H

#include <stdio.h>

#include "base/status.h"

/* Whether gnuplot is there and runs; STATUS_UNABLE (reported) where not. For a failure before the work. */
enum status gnuplot_check(void);

/* Runs gnuplot on a script that plots to its svg terminal and writes what it drew, without the <svg> element
 * around it, to out. Each id in it gets the prefix, so that several drawings can stand on a page. Settings of
 * the user (~/.gnuplot) are not read. On STATUS_UNABLE (reported) nothing has been written. */
enum status gnuplot_draw(const char *script, const char *id_prefix, FILE *out);

#endif
