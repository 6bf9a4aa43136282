#ifndef VKWHITTED_BENCH_GROUND_TRUTH_H
#define VKWHITTED_BENCH_GROUND_TRUTH_H

#include "bench/pixel_grid.h"
#include "scene/pack.h"

/* What errors are measured against: the reference at high precision, as far as it is affordable, which may be
 * at some of the pixels only. What is computed depends on the scene and its size, not on the machine. */
struct ground_truth {
    struct pixel_grid grid;
    double *rgb; /* 3 a pixel of the grid */
    enum precision precision;
    char text[200]; /* what it is, for people */
};

/* How much work a truth may be: rays times objects. */
struct bench_effort {
    double quad_work, double_work;
    unsigned samples; /* of what is sampled */
};

/* The most bounces, at least the scene's and otherwise at most 64, with which rays do not multiply beyond
 * reason. *has_secondary_rays gets whether there is anything that rays bounce from. */
enum status bench_deepest(const struct scene *scene, const struct picture_settings *settings,
                          unsigned *deepest, bool *has_secondary_rays);

/* The picture with `deepest` bounces and converged light samples: quad, or double where lights are sampled.
 */
enum status ground_truth_create(const struct scene *scene, struct picture_settings settings, unsigned deepest,
                                const struct bench_effort *effort, struct progress *progress,
                                double progress_total, struct ground_truth *truth);

/* The picture as the settings say but for converged pixel samples, in double. */
enum status ground_truth_create_filtered(const struct scene *scene, struct picture_settings settings,
                                         const struct bench_effort *effort, struct progress *progress,
                                         double progress_total, struct ground_truth *truth);
void ground_truth_destroy(struct ground_truth *truth);

/* So many pixels of the scene are about this much work in quad with the error analysis. */
double bench_explained_pixels(const struct packed_scene *packed, double work);

#endif
