#ifndef VKWHITTED_BENCH_BENCH_H
#define VKWHITTED_BENCH_BENCH_H

#include <jansson.h>
#include <stdio.h>

#include "tracer/job.h"

/* The bench document without a scene: the command line and what times depend on. STATUS_UNABLE (reported)
 * without memory or where the command line is not UTF-8. The caller frees *document. */
enum status bench_document(int argc, char **argv, bool quick, const struct vulkan_context *context,
                           json_t **document);

/* Measures one scene: of the job's options with the size, the shaders and quiet; without a context on the CPU
 * alone; with fewer settings and runs if quick. *scene gets an element for the document's "scenes"; NULL with
 * any status but STATUS_DONE. */
enum status bench_scene(const struct job_options *options, struct vulkan_context *context, bool quick,
                        const char *path, json_t **scene);

/* A scene of the bench document for people: a line a setting, then the fitted slopes and a recommendation for
 * each of four errors. */
void bench_print_scene(const json_t *scene, FILE *stream);

/* All points of all scenes of the document, one a line under a line of names (RFC 4180). The file appears
 * whole or not at all, as does the report. */
enum status bench_csv_write(const json_t *document, const char *path);

/* Writes the bench document as one HTML page that needs nothing else: report.html with the document in it. */
enum status report_write(const json_t *document, const char *path);

/* Reads an earlier bench's JSON file; STATUS_REFUSED (reported) if it is not one. The caller frees *document.
 */
enum status bench_document_read(const char *path, json_t **document);

/* Prints what differs between two bench documents beyond noise, setting by setting: faster, slower, more or
 * less accurate. STATUS_DIFFERS if anything became slower or less accurate, STATUS_REFUSED (reported) if the
 * documents have no setting in common.
 *
 * Times differ beyond noise if the medians differ by more than 5 % and by more than four standard errors
 * of their difference: with a standard error of 1.2533 s / sqrt(n) for a median of n runs, s = the distance
 * of the quartiles / 1.349, and with that distance, relative to the median, at least the bench's typical one.
 * Four: with a hundred settings, one bench in a hundred and fifty is wrong where noise is normal. The machine
 * as a whole may have become slower or faster between the two benches, which neither tells by itself. So the
 * change must be as far beyond noise in proportion to the other backend's median change, device and CPU
 * serving as each other's control; the variance of that median counts as noise, too. Times of another machine
 * or device are not compared.
 *
 * Errors have no noise, for pictures are functions of the scene: any rise of RMSE or of the largest error
 * counts, but in pictures of scenes with sampled lights and of several pixel samples, where another choice of
 * points is as good: there RMSE must rise by more than four standard errors. Errors against another truth, as
 * for another size, are not compared. */
enum status bench_compare(const json_t *old, const json_t *new, FILE *stream);

#endif
