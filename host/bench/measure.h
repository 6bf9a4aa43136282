#ifndef VKWHITTED_BENCH_MEASURE_H
#define VKWHITTED_BENCH_MEASURE_H

#include "bench/bench.h"
#include "bench/ground_truth.h"

enum { BENCH_MAX_SETTINGS = 128, BENCH_MAX_RUNS = 51 }; /* there are 80 settings at most */

/* The knobs that a bench turns, one at a time. */
enum bench_family {
    FAMILY_MODE, /* exact, fast, double */
    FAMILY_CPU,
    FAMILY_MAX_ERROR,
    FAMILY_BOUNCES,
    FAMILY_LIGHT_SAMPLES,
    FAMILY_SAMPLES,
};

/* One way to render the scene, and what was measured of it. */
struct bench_point {
    enum bench_family family;
    enum backend backend;
    struct picture_settings picture;
    struct render_plan plan; /* what it renders, of the point's own packed scene; it must not move */
    char label[48];          /* short, for people */
    char options[96];        /* to paste: "" is what the scene says */

    struct packed_scene packed;
    struct tracer *tracer; /* on a device, ready to render */
    double setup_ms, first_ms;
    double runs_ms[BENCH_MAX_RUNS]; /* of the warm runs; ascending in the end */
    size_t run_count;
    double spent_ms;
    double median_ms, quartiles_ms[2];
    struct reference_rays rays; /* of a device's points as they are in float */
    struct bench_error error;
    bool pareto;
};

/* What a bench may cost. */
struct bench_effort {
    struct {
        double quad, with_double; /* by precision, in rays times objects */
    } truth;
    double longest_run_ms; /* a family ends where its next run would take longer */
    struct {
        size_t least, most;      /* warm runs of a point */
        double point_ms, all_ms; /* when a point, and when all points, make no more than their least runs */
    } runs;
    double whole_ms; /* a bench that has taken longer starts no more knobs and makes the least runs only */
};

/* Parts of the progress bar. */
enum { TRUTH_SHARE = 120, FILTERED_SHARE = 220, START_SHARE = 240, RUNS_SHARE = 300 };

/* A bench of one scene. */
struct bench {
    struct vulkan_context *context; /* NULL: the CPU alone */
    bool quick;
    const struct bench_effort *effort;
    double start_ms;
    struct progress progress;
    struct job job;                  /* the scene as it is */
    struct picture_settings picture; /* the same */
    bool has_secondary_rays, has_quad_lights;
    unsigned deepest;                    /* bounces that a picture with all bounces may cost */
    struct ground_truth truth, filtered; /* for all families but samples; for those */
    struct bench_point points[BENCH_MAX_SETTINGS];
    size_t count;
    struct image image; /* the last picture */
};

/* Puts the settings worth measuring to the points, a family's cheapest first. */
void bench_settings(struct bench *bench);

/* Puts these to the points and measures them: first each once, with its error against the truth, and then all
 * in rounds. */
enum status bench_measure(struct bench *bench);

#endif
