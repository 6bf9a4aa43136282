#ifndef VKWHITTED_CHECK_JUDGE_H
#define VKWHITTED_CHECK_JUDGE_H

#include "base/json.h"
#include "check/heatmap.h"
#include "reference.h"

/* How far a float picture is from the exact one. */
struct judgement {
    double median, percentile_99, percentile_99_99,
        max; /* relative; over pixels of the same path signature */
    unsigned max_x, max_y;
    size_t tight;             /* pixels with a bound of at most 1e-2 in each channel */
    size_t wide[CAUSE_COUNT]; /* the others, by what widens it most */
    double worst_share;       /* largest error / bound of those that are tight */
    size_t other_signature;   /* pixels whose tree of rays took another way */
    size_t unexplained; /* pixels beyond their bound, or of another signature without a close decision */
    unsigned unexplained_x, unexplained_y; /* the first */
};

/* Judges the picture and its path signatures by the explanations, pixel by pixel, all of the image's size.
 * STATUS_DIFFERS if a pixel is unexplained, STATUS_UNABLE (reported) without memory. */
enum status judge_picture(const struct image *image, const uint32_t *signatures,
                          const struct reference_explanation *explanations, struct judgement *judgement);

/* Prints the judgement by an exact picture of that precision in a line; so many pixels may be unexplained. */
void judgement_print(const struct judgement *judgement, const char *scene, const char *precision,
                     size_t allowed);

/* The same as a JSON object; NULL without memory or where the scene's name is not UTF-8. */
json_t *judgement_json(const struct judgement *judgement, const char *scene, const char *precision,
                       size_t allowed);

/* Two pictures side by side: the pixels' relative errors and, likewise, their bounds, 2^-24 dark to 1 bright,
 * both logarithmic in the colours of viridis. */
struct judged_picture {
    const struct image *image;
    const struct reference_explanation *explanations;
};
struct heatmap judgement_heatmap(const struct judged_picture *picture);

#endif
