#ifndef VKWHITTED_REFERENCE_H
#define VKWHITTED_REFERENCE_H

#include <stdint.h>

#include "packed_scene.h"

struct reference_rays {
    uint64_t primary, secondary, shadow;
};

static inline void rays_add(struct reference_rays *sum, struct reference_rays more)
{
    sum->primary += more.primary;
    sum->secondary += more.secondary;
    sum->shadow += more.shadow;
}

/* Part of the picture, in pixels from the top left. */
struct reference_window {
    int x, y, width, height;
};

/* What the window's pixels get, row by row from the top. */
struct reference_picture {
    double *rgb;                /* linear RGB radiance, rounded to double: 3 * width * height */
    uint32_t *signatures;       /* hash of every decision of the ray tree; NULL: not wanted */
    double *charges;            /* for rays that were not traced; NULL: not wanted */
    struct reference_rays rays; /* what was traced is added */
};

/* Traces the window of the scene's picture in float, double or binary128, on so many threads. The float build
 * computes what the shader does in exact mode, operation by operation. */
void reference_render_float(const struct packed_scene *scene, struct reference_window window, int threads,
                            struct reference_picture *picture);
void reference_render_double(const struct packed_scene *scene, struct reference_window window, int threads,
                             struct reference_picture *picture);
void reference_render_quad(const struct packed_scene *scene, struct reference_window window, int threads,
                           struct reference_picture *picture);

/* What widens a pixel's bound most. */
enum reference_cause {
    CAUSE_ROUNDING,
    CAUSE_HIT,        /* float may hit another surface, or none */
    CAUSE_SHADOW,     /* a point of a light may be hidden in float and is not, or the other way round */
    CAUSE_REFLECTION, /* likewise total reflection */
    CAUSE_UNKNOWN,    /* any of these where the scene's radiance has no bound: the pixel's says nothing */
    CAUSE_COUNT
};

/* The exact picture's pixel, and what float may make of it. */
struct reference_explanation {
    double rgb[3];   /* linear radiance at high precision */
    double bound[3]; /* on float's error, whatever it decides */
    double margin;   /* of the closest decision: below 1, float may decide otherwise; see margin.h. At least
                      * 1, it may be larger with scene->tree than without */
    uint32_t
        signature;  /* hash of every decision of the ray tree: float's, too, unless the margin is below 1 */
    uint32_t cause; /* enum reference_cause, of the bound */
};

/* Traces the window in double or binary128 with the error analysis of NUMERICS.md: width * height
 * explanations, row by row from the top. */
void reference_explain_double(const struct packed_scene *scene, struct reference_window window, int threads,
                              struct reference_explanation *explanations);
void reference_explain_quad(const struct packed_scene *scene, struct reference_window window, int threads,
                            struct reference_explanation *explanations);

#endif
