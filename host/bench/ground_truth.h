#ifndef VKWHITTED_BENCH_GROUND_TRUTH_H
#define VKWHITTED_BENCH_GROUND_TRUTH_H

#include "bench/pixel_grid.h"
#include "scene/pack.h"

/* What errors are measured against: the reference at high precision, as far as it is affordable, which may be
 * at some of the pixels only. What is computed depends on the scene and its size, not on the machine. */
struct ground_truth {
    struct pixel_grid grid;
    double *rgb;    /* 3 a pixel of the grid */
    char text[200]; /* what it is, for people */
};

/* How much work truths may be: rays times objects. */
struct truth_effort {
    double quad, with_double, explained; /* explained: quad with the error analysis */
    unsigned samples;                    /* of what is sampled */
};

/* The most bounces, at least the scene's and otherwise at most 64, with which rays do not multiply beyond
 * reason. */
enum status ground_truth_bounces(const struct packed_scene *packed, unsigned *most);

/* The picture with the settings' bounces and converged light samples, in quad, or in double where lights are
 * sampled. On failure (reported) the truth is empty; otherwise the caller frees it. Advances progress by
 * `share`. */
enum status ground_truth_create(const struct scene *scene, struct picture_settings settings, bool sampled,
                                const struct truth_effort *effort, struct progress *progress, double share,
                                struct ground_truth *truth);

/* The picture as the settings say but for converged pixel samples, in double; the rest as above. */
enum status ground_truth_create_filtered(const struct scene *scene, struct picture_settings settings,
                                         const struct truth_effort *effort, struct progress *progress,
                                         double share, struct ground_truth *truth);
void ground_truth_destroy(struct ground_truth *truth);

/* The finest grid over the packed scene's picture that is about so much work. */
enum status grid_of_work(const struct packed_scene *packed, double work, struct pixel_grid *grid);

#endif
