#ifndef VKWHITTED_BENCH_SETTINGS_H
#define VKWHITTED_BENCH_SETTINGS_H

#include "scene/pack.h"
#include "tracer/render.h"

/* The knobs that a bench turns, one at a time. */
enum bench_family {
    FAMILY_MODE, /* exact, fast, double */
    FAMILY_CPU,
    FAMILY_MAX_ERROR,
    FAMILY_BOUNCES,
    FAMILY_LIGHT_SAMPLES,
    FAMILY_SAMPLES,
};

/* One way to render the scene. */
struct bench_setting {
    enum bench_family family;
    enum backend backend;
    enum precision precision;
    bool fast;
    unsigned threads; /* of the CPU; 0: all */
    struct picture_settings picture;
    char label[48];   /* short, for people */
    char options[96]; /* to paste: "" is what the scene says */
};

/* What there is to turn. */
struct bench_choice {
    struct picture_settings picture; /* the scene's */
    enum backend backend;            /* that the knobs of the picture are measured on */
    bool has_float64;                /* the device */
    bool has_secondary_rays, has_quad_lights;
    unsigned deepest; /* bounces that a picture with all bounces may cost */
    bool quick;       /* fewer values */
};

enum { BENCH_MAX_SETTINGS = 96 };

/* The settings worth measuring, a family's cheapest first. Returns their number. */
size_t bench_settings(const struct bench_choice *choice, struct bench_setting settings[BENCH_MAX_SETTINGS]);

#endif
