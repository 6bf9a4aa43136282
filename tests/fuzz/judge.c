/* Random scenes that break ray tracers: float's picture of 8x8 pixels is judged by double's. It has no NaN,
 * and no pixel that the error analysis does not explain.
 * The bytes choose the scene. One with a finding is printed, for `vkwhitted check --backend cpu --against
 * double`. */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/judge.h"
#include "fuzz.h"
#include "random.h"
#include "reference.h"
#include "scene/pack.h"

enum { SIDE = 8, PIXELS = SIDE * SIDE, MOST_BODIES = 6, MOST_MATERIALS = 5 };

/* Bytes that are given first; then those that follow from them. */
struct source {
    const uint8_t *data;
    size_t left;
    struct random random;
};

static unsigned choose(struct source *source, unsigned count)
{
    if (source->left == 0)
        return random_below(&source->random, count);
    --source->left;
    return *source->data++ % count;
}

#define CHOOSE(source, ...)                                                                                  \
    ((const double[]){__VA_ARGS__})[choose(source, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))]

struct sketch_body {
    bool is_ball;
    struct dvec3 place; /* centre, or a point of the plane */
    struct dvec3 normal;
    double radius;
    bool is_glass;
};

/* The scene as it is being written. */
struct sketch {
    struct source source;
    char text[1 << 14];
    size_t length;
    double scale; /* of most of its lengths */
    struct sketch_body bodies[MOST_BODIES];
    unsigned body_count;
    unsigned material_count;
    bool glass[MOST_MATERIALS], any_glass;
    unsigned samples; /* a pixel */
};

__attribute__((format(printf, 2, 3))) static void put(struct sketch *sketch, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length =
        vsnprintf(sketch->text + sketch->length, sizeof sketch->text - sketch->length, format, arguments);
    va_end(arguments);
    sketch->length += (size_t)length;
    if (sketch->length >= sizeof sketch->text)
        abort();
}

static void put_vector(struct sketch *sketch, const char *key, struct dvec3 v)
{
    put(sketch, "%s: [%.17g, %.17g, %.17g]", key, v.x, v.y, v.z);
}

/* In [-1, 1]. */
static double uniform(struct source *source)
{
    return (choose(source, 256) + choose(source, 256) / 256.0) / 128 - 1;
}

static double power_of_ten(struct source *source, int least, int most)
{
    return pow(10, least + (int)choose(source, (unsigned)(most - least + 1)));
}

/* Small round numbers, so that surfaces touch, and others. */
static double coordinate(struct source *source)
{
    switch (choose(source, 4)) {
    case 0:
        return 3 * uniform(source);
    case 1:
        return CHOOSE(source, 0, 0, 1e-3, -1e-7, 1e4, 1e-12, 1 + 0x1p-23, -1 - 0x1p-22, 100, 0.1, -0.3);
    default:
        return CHOOSE(source, 0, 1, -1, 2, -2, 3, 0.5, -0.5, 1.5);
    }
}

static struct dvec3 direction(struct source *source)
{
    struct dvec3 v;
    if (choose(source, 2)) {
        const double sign = choose(source, 2) ? 1 : -1;
        const unsigned axis = choose(source, 3);
        return (struct dvec3){axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
    }
    do {
        v.x = uniform(source);
        v.y = uniform(source);
        v.z = uniform(source);
    } while (dvec3_dot(v, v) < 1e-4);
    return choose(source, 4) ? dvec3_unit(v) : v;
}

/* Somewhere, or where it matters: on a body, in it, beside it. */
static struct dvec3 place(struct sketch *sketch)
{
    struct source *source = &sketch->source;
    if (sketch->body_count > 0 && choose(source, 2)) {
        const struct sketch_body *body = &sketch->bodies[choose(source, sketch->body_count)];
        const double away = CHOOSE(source, 0, 1, 1, 1, 0.5, 1 + 1e-7, 1 - 1e-7, 1 + 1e-4, 2, 10);
        if (body->is_ball)
            return dvec3_along(body->place, away * body->radius, dvec3_unit(direction(source)));
        const struct dvec3 across = dvec3_cross(body->normal, direction(source));
        return dvec3_along(dvec3_along(body->place, sketch->scale * (away - 1), dvec3_unit(body->normal)),
                           sketch->scale * coordinate(source), across);
    }
    struct dvec3 v;
    v.x = coordinate(source);
    v.y = coordinate(source);
    v.z = coordinate(source);
    return dvec3_scale(sketch->scale, v);
}

static void put_materials(struct sketch *sketch)
{
    struct source *source = &sketch->source;
    sketch->material_count = 1 + choose(source, MOST_MATERIALS);
    put(sketch, "materials:\n");
    for (unsigned i = 0; i < sketch->material_count; ++i) {
        const unsigned kind = choose(source, 5);
        put(sketch, "  - { name: M%u, type: ", i);
        if (kind < 2) {
            const double red = CHOOSE(source, 1, 0.5, 0, 0.9), green = CHOOSE(source, 1, 0.5, 0, 0.9);
            put(sketch, "matte, color: [%g, %g, 0.7], roughness: %g }\n", red, green,
                CHOOSE(source, 0, 0, 0.6, 0.1, 1e-3, 3, 1e3));
        } else if (kind == 2) {
            put(sketch, "mirror }\n");
        } else {
            put(sketch, "transparent, ior: %.17g }\n",
                CHOOSE(source, 1.3, 1.5, 2.42, 1, 1 + 1e-6, 1 - 1e-6, 1 / 1.5, 1.0001, 4, 1e-3, 1e3, 0.5));
            sketch->glass[i] = true;
        }
    }
}

/* A ball that may touch another, lie in it or around it. */
static void draw_ball(struct sketch *sketch, struct sketch_body *body)
{
    struct source *source = &sketch->source;
    body->is_ball = true;
    body->radius = sketch->scale * CHOOSE(source, 1, 1, 0.5, 2, 1.5, 0.3, 0.01, 10, 1e3, 1e6);
    if (choose(source, 6) == 0)
        body->radius *= power_of_ten(source, -16, 4);
    body->place = place(sketch);
    if (sketch->body_count == 0 || choose(source, 2))
        return;
    const struct sketch_body *other = &sketch->bodies[choose(source, sketch->body_count)];
    const struct dvec3 way = other->is_ball ? dvec3_unit(direction(source)) : dvec3_unit(other->normal);
    const double reach = other->is_ball ? other->radius : 0;
    if (other->is_ball && choose(source, 2))
        body->radius = other->radius * CHOOSE(source, 1, 0.5, 0.99, 0.999999, 1.0000001, 0.1, 2);
    switch (choose(source, 3)) {
    case 0: /* beside it, touching or nearly so */
        body->place =
            dvec3_along(other->place, (reach + body->radius) * CHOOSE(source, 1, 1, 1 + 1e-6, 1 - 1e-6), way);
        break;
    case 1: /* touching from inside */
        body->place = dvec3_along(other->place, reach - body->radius, way);
        break;
    default:
        body->place = other->place;
    }
}

static void draw_plane(struct sketch *sketch, struct sketch_body *body)
{
    body->place = place(sketch);
    body->normal = direction(&sketch->source);
    if (sketch->body_count > 0 && choose(&sketch->source, 2)) {
        const struct sketch_body *other = &sketch->bodies[choose(&sketch->source, sketch->body_count)];
        if (!other->is_ball) /* parallel */
            body->normal = dvec3_scale(choose(&sketch->source, 2) ? 1 : -1, other->normal);
    }
}

static void put_bodies(struct sketch *sketch)
{
    const unsigned count = choose(&sketch->source, MOST_BODIES + 1);
    put(sketch, "%s", count > 0 ? "objects:\n" : "");
    for (unsigned i = 0; i < count; ++i) {
        struct sketch_body *body = &sketch->bodies[i];
        const unsigned material = choose(&sketch->source, sketch->material_count);
        *body = (struct sketch_body){.is_ball = false};
        if (choose(&sketch->source, 3))
            draw_ball(sketch, body);
        else
            draw_plane(sketch, body);
        sketch->body_count = i + 1;
        sketch->any_glass |= sketch->glass[material];
        put(sketch, "  - { name: B%u, material: M%u, type: ", i, material);
        if (body->is_ball) {
            put_vector(sketch, "sphere, center", body->place);
            put(sketch, ", radius: %.17g }\n", body->radius);
        } else {
            put_vector(sketch, "plane, point", body->place);
            put_vector(sketch, ", normal", body->normal);
            put(sketch, " }\n");
        }
    }
}

static void put_lights(struct sketch *sketch)
{
    struct source *source = &sketch->source;
    const unsigned count = choose(source, 4);
    put(sketch, "%s", count > 0 ? "lights:\n" : "");
    for (unsigned i = 0; i < count; ++i) {
        const double power = CHOOSE(source, 1, 30, 0, 1e-6, 1e5);
        if (choose(source, 3)) {
            put_vector(sketch, "  - { type: point, position", place(sketch));
            put(sketch, ", power: %.17g }\n", power * sketch->scale * sketch->scale);
        } else {
            const double size = sketch->scale * CHOOSE(source, 1, 2, 0.1, 1e-4, 10);
            put_vector(sketch, "  - { type: quad, corner", place(sketch));
            put_vector(sketch, ", u", dvec3_scale(size, direction(source)));
            put_vector(sketch, ", v", dvec3_scale(size, direction(source)));
            put(sketch, ", power: %.17g, color: [1, 0, 0.5] }\n", power);
        }
    }
}

static void put_camera(struct sketch *sketch)
{
    struct source *source = &sketch->source;
    put_vector(sketch, "camera: { position", place(sketch));
    put_vector(sketch, ", look_at", place(sketch));
    put_vector(sketch, ", up", direction(source));
    put(sketch, ", fov_y: %.17g }\n",
        CHOOSE(source, 60, 60, 60, 20, 90, 120, 1, 1e-3, 170, 179.9, 179.999999, 180 - 0x1p-44, 1e-300));
    put(sketch, "image: { width: %d, height: %d }\n", SIDE, SIDE);
    const double background = CHOOSE(source, 0.5, 0, 1, 1e-9, 1e3);
    put(sketch, "background: [%g, %g, %g]\n", background, background, background / 2);
    const unsigned most_bounces = sketch->any_glass ? 8 : 41;
    put(sketch, "max_bounces: %u\nlight_samples: %u\n", choose(source, most_bounces), 1 + choose(source, 4));
}

static void draw_scene(const uint8_t *data, size_t size, struct sketch *sketch)
{
    *sketch = (struct sketch){.source = {.data = data, .left = size}};
    for (size_t i = 0; i < size; ++i)
        sketch->source.random.state = (sketch->source.random.state + data[i]) * UINT64_C(0x9e3779b97f4a7c15);
    sketch->scale = choose(&sketch->source, 4) ? 1 : power_of_ten(&sketch->source, -12, 9);
    put_materials(sketch);
    put_bodies(sketch);
    put_lights(sketch);
    put_camera(sketch);
    sketch->samples = choose(&sketch->source, 4) ? 1 : 3;
}

static void fail(const struct sketch *sketch, const char *what, unsigned x, unsigned y)
{
    printf("%s @ (%u, %u) with --samples %u in\n%s\n", what, x, y, sketch->samples, sketch->text);
    fflush(stdout);
    abort();
}

static void judge(const struct packed_scene *packed, const struct sketch *sketch)
{
    float rounded[3 * PIXELS];
    uint32_t signatures[PIXELS];
    struct reference_explanation explanations[PIXELS];
    struct judgement judgement;
    for (unsigned i = 0; i < PIXELS; ++i) {
        const int x = (int)(i % SIDE), y = (int)(i / SIDE);
        const struct reference_pixel pixel = reference_trace_float(packed, x, y, NULL);
        const struct reference_explanation *exact = &explanations[i];
        explanations[i] = reference_explain_double(packed, x, y, NULL);
        signatures[i] = pixel.signature;
        bool finite = isfinite(pixel.charges) && exact->margin >= 0;
        for (unsigned c = 0; c < 3; ++c) {
            rounded[3 * i + c] = (float)pixel.rgb[c];
            finite = finite && isfinite(pixel.rgb[c]) && isfinite(exact->rgb[c]) && isfinite(exact->bound[c]);
        }
        if (!finite)
            fail(sketch, "not finite", i % SIDE, i / SIDE);
    }
    const struct image image = {.width = SIDE, .height = SIDE, .rgb = rounded};
    if (judge_picture(&image, signatures, explanations, &judgement) != STATUS_DONE)
        fail(sketch, "unexplained", judgement.unexplained_x, judgement.unexplained_y);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct sketch sketch;
    struct scene scene;
    struct packed_scene packed;
    draw_scene(data, size, &sketch);
    if (scene_read_text("fuzz.yaml", sketch.text, sketch.length, &scene) != STATUS_DONE)
        return 0;
    const struct picture_settings settings = {.width = SIDE,
                                              .height = SIDE,
                                              .max_bounces = scene.max_bounces,
                                              .samples = sketch.samples,
                                              .light_samples = scene.light_samples};
    if (pack_scene(NULL, &scene, &settings, &packed) == STATUS_DONE) {
        judge(&packed, &sketch);
        pack_destroy(&packed);
    }
    scene_destroy(&scene);
    return 0;
}
