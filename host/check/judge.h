#ifndef VKWHITTED_CHECK_JUDGE_H
#define VKWHITTED_CHECK_JUDGE_H

#include "base/json.h"
#include "image/image.h"
#include "reference.h"

/* How far a float picture is from the exact one. A pixel's relative error is the largest over its channels of
 * |float - exact| / max(|exact|, 1e-3). */
struct judgement {
    double median, percentile_99, percentile_99_99, max; /* over pixels of the same path signature */
    unsigned max_x, max_y;
    double worst_share;     /* largest error / bound where no decision is close */
    size_t other_signature; /* pixels whose tree of rays took another way */
    size_t close_decisions; /* pixels with a decision that float may take either way */
    size_t unexplained;     /* pixels without one that are beyond their bound, or of another signature */
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

/* Writes an 8-bit PNG with two pictures side by side: the relative error, 2^-24 dark to 1 bright, and the
 * margin, 1 or less bright to 2^24 dark, both logarithmic in the colours of viridis. */
enum status judgement_heatmap(const struct image *image, const struct reference_explanation *explanations,
                              const char *path);

#endif
