#ifndef VKWHITTED_BENCH_REPORT_TABLES_H
#define VKWHITTED_BENCH_REPORT_TABLES_H

#include <jansson.h>
#include <stdio.h>

/* The tables of the page, from the parts of the bench document they show. Failed writes stay in the stream's
 * error flag. */

/* All scenes, with where device and reference differ and how far rounding goes. */
void report_agreement(const json_t *scenes, FILE *out);

/* The fastest settings within each error. */
void report_recommendations(const json_t *scene, FILE *out);

/* All settings measured; row i has the id "sINDEX-pI". */
void report_points(const json_t *scene, size_t index, FILE *out);

void report_machine(const json_t *machine, FILE *out);

#endif
