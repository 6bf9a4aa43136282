#ifndef VKWHITTED_CHECK_VERDICT_H
#define VKWHITTED_CHECK_VERDICT_H

#include "base/json.h"
#include "check/compare.h"
#include "check/heatmap.h"
#include "image/read.h"
#include "reference.h"

/* How a picture by any program compares with the exact one. Its error is how far a value is from all that its
 * file's format may have rounded to it. */
enum verdict {
    VERDICT_RIGHT,         /* off by no more than the bound on the float tracer's error and the tolerance */
    VERDICT_NEAR_DECISION, /* likewise, but by a thousandth of its value or more, and only because of a
                            * decision that float may take either way */
    VERDICT_SLIGHTLY_OFF,  /* wrong, by less than 1e-4 of its value: another program's rounding */
    VERDICT_EDGE,          /* wrong, and a decision is within a thousand of float's roundings */
    VERDICT_WRONG,         /* otherwise wrong: the formula, or the scene */
    VERDICT_COUNT
};

struct verdicts {
    size_t pixels[VERDICT_COUNT];
    bool any_wrong;
    /* The largest error, of the wrong pixels where there are some. */
    double error;
    unsigned x, y, channel;
    struct value_range value;
    double exact, bound, margin; /* there */
};

/* Pixel by pixel, all of the picture's size. STATUS_DIFFERS if a pixel is wrong. */
enum status verdicts_find(const struct read_image *picture, const struct reference_explanation *explanations,
                          const struct tolerance *tolerance, struct verdicts *verdicts);

size_t verdicts_wrong(const struct verdicts *verdicts);

/* Prints how the picture compares with the exact one of that precision; so many pixels may be wrong. */
void verdicts_print(const struct verdicts *verdicts, const char *scene, const char *picture,
                    const char *precision, size_t allowed);

/* The same as a JSON object; NULL without memory or where a name is not UTF-8. */
json_t *verdicts_json(const struct verdicts *verdicts, const char *scene, const char *picture,
                      const char *precision, size_t allowed);

/* Right pixels black, those near a decision blue, wrong ones from violet to yellow by their relative error,
 * 2^-24 to 1, logarithmic. */
struct compared_picture {
    const struct read_image *picture;
    const struct reference_explanation *explanations;
    const struct tolerance *tolerance;
};
struct heatmap verdicts_heatmap(const struct compared_picture *compared);

#endif
