#ifndef VKWHITTED_REFERENCE_H
#define VKWHITTED_REFERENCE_H

#include <stddef.h>
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

/* One step of a pixel's ray tree; scene_layout.h says what the kinds hold. Lengths are in scene units. */
struct reference_event {
    struct EventHead head;
    double values[EVENT_VALUES];
    double bounds[EVENT_VALUES]; /* on float's error in each value; the analysis alone knows it */
    double margin; /* of the decisions made here, as in margin.h; INFINITY where there are none */
};

/* Events in the order of the recursion. Those beyond the room are counted and not kept. */
struct reference_log {
    struct reference_event *events;
    size_t room, count;
};

/* A pixel, and what was traced for it. */
struct reference_pixel {
    double rgb[3];      /* linear radiance, rounded to double */
    double charges;     /* for rays that were not traced */
    uint32_t signature; /* hash of every decision of the ray tree */
    struct reference_rays rays;
};

/* Traces the pixel at (x, y) of the scene's picture, from the top left, in float, double or binary128. The
 * float build computes what the shader does in exact mode, operation by operation. What happens is appended
 * to the log, if there is one. */
typedef struct reference_pixel reference_tracer(const struct packed_scene *scene, int x, int y,
                                                struct reference_log *log);
reference_tracer reference_trace_float, reference_trace_double, reference_trace_quad;

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

/* Traces the pixel in double or binary128 with the error analysis of NUMERICS.md. The log gets bounds and
 * margins as well; no EVENT_SAMPLE, and no charges. */
typedef struct reference_explanation reference_explainer(const struct packed_scene *scene, int x, int y,
                                                         struct reference_log *log);
reference_explainer reference_explain_double, reference_explain_quad;

#endif
