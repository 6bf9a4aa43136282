/* Pictures against numbers that were found without this program. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>

#include "test_render.h"

static const double pi = 3.14159265358979323846;

/* Float's 2^-24 times the few dozen operations and the few bounces of a pixel, amplified by spheres. */
static void assert_near(double value, double expected, const char *what)
{
    if (fabs(value - expected) <= 1e-5 + 5e-5 * fabs(expected))
        return;
    print_error("%s: %.9g, expected %.9g\n", what, value, expected);
    fail();
}

/* One pixel of a scene, 0-based from the top left, as every renderer has it. */
static void check_pixel(const struct scene *scene, unsigned x, unsigned y, const double expected[3])
{
    for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
        struct rendering rendering =
            test_render_scene(scene, (enum test_renderer)renderer, (struct window){x, y, 1, 1});
        for (int c = 0; c < 3; ++c) {
            char what[128];
            snprintf(what, sizeof what, "%s, pixel (%u, %u), channel %d, %s", scene->path, x, y, c,
                     test_renderer_names[renderer]);
            assert_near((double)rendering.image.rgb[c], expected[c], what);
        }
        image_destroy(&rendering.image);
    }
}

struct pixel_value {
    const char *scene;
    unsigned x, y;
    double rgb[3];
};

/* Lambert: the figures with roughness 0. Radiance albedo / pi cos power / d^2 along the rays and Fresnel's
 * k_r and 1 - k_r where glass splits them, by hand. */
static void lambert_figures(void **state)
{
    static const struct pixel_value values[] = {
        {"scenes/figure_2a.yaml", 310, 150, {.314788, 0, .314788}},          /* far wall */
        {"scenes/figure_2a.yaml", 50, 200, {.770356, 0, 0}},                 /* left wall */
        {"scenes/figure_2a.yaml", 300, 350, {.138940, .138940, .138940}},    /* ground */
        {"scenes/figure_2a.yaml", 150, 360, {0, 0, 0}},                      /* in a sphere's shadow */
        {"scenes/figure_2a.yaml", 370, 240, {1.376701, 1.376701, 1.376701}}, /* sphere */
        {"scenes/figure_4.yaml", 220, 280, {.159695, .000124, .159722}},     /* through the glass sphere */
        {"scenes/figure_4.yaml", 243, 310, {.172948, .014344, .172948}},     /* near its rim */
        {"scenes/figure_4.yaml", 370, 240, {0, 3.265356, 0}},                /* the ceiling in the mirror */
    };
    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        struct scene scene = test_read(values[i].scene);
        for (size_t m = 0; m < scene.material_count; ++m)
            scene.materials[m].roughness = 0;
        check_pixel(&scene, values[i].x, values[i].y, values[i].rgb);
        scene_destroy(&scene);
    }
}

/* Oren and Nayar's formula as their paper has it, with angles, f = albedo / pi (A + B max(0, cos(phi_i -
 * phi_r)) sin alpha tan beta), alpha the larger and beta the smaller of the polar angles. All in double, from
 * vectors that point away from the surface. */
static double oren_nayar_by_angles(const double normal[3], const double to_light[3], const double to_eye[3],
                                   double sigma)
{
    double across[3] = {fabs(normal[0]) > 0.5 ? 0 : 1, fabs(normal[0]) > 0.5 ? 1 : 0, 0};
    double along_normal = across[0] * normal[0] + across[1] * normal[1];
    double t[3], b[3], length = 0;
    for (int i = 0; i < 3; ++i) {
        t[i] = across[i] - along_normal * normal[i];
        length += t[i] * t[i];
    }
    for (int i = 0; i < 3; ++i)
        t[i] /= sqrt(length);
    for (int i = 0; i < 3; ++i)
        b[i] = normal[(i + 1) % 3] * t[(i + 2) % 3] - normal[(i + 2) % 3] * t[(i + 1) % 3];
    double polar[2], azimuth[2];
    const double *directions[2] = {to_light, to_eye};
    for (int k = 0; k < 2; ++k) {
        const double *d = directions[k];
        double n = d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2];
        double x = d[0] * t[0] + d[1] * t[1] + d[2] * t[2];
        double y = d[0] * b[0] + d[1] * b[1] + d[2] * b[2];
        polar[k] = atan2(sqrt(x * x + y * y), n);
        azimuth[k] = atan2(y, x);
    }
    double a_term = 1 - 0.5 * sigma * sigma / (sigma * sigma + 0.33);
    double b_term = 0.45 * sigma * sigma / (sigma * sigma + 0.09);
    double alpha = fmax(polar[0], polar[1]), beta = fmin(polar[0], polar[1]);
    return (a_term + b_term * fmax(0, cos(azimuth[0] - azimuth[1])) * sin(alpha) * tan(beta)) / pi;
}

/* The distance along origin + t direction (any length) to the object by the textbook's equations, INFINITY if
 * it is not in front. */
static double textbook_distance(const struct scene_object *object, const double origin[3],
                                const double direction[3])
{
    double a = 0, b = 0, c = 0;
    for (int i = 0; i < 3; ++i) {
        if (object->type == OBJECT_PLANE) {
            a += object->plane.normal[i] * direction[i];
            b += object->plane.normal[i] * (object->plane.point[i] - origin[i]);
        } else {
            double offset = origin[i] - object->sphere.center[i];
            a += direction[i] * direction[i];
            b += 2 * offset * direction[i];
            c += offset * offset;
        }
    }
    if (object->type == OBJECT_PLANE)
        return b / a > 1e-9 ? b / a : INFINITY;
    c -= object->sphere.radius * object->sphere.radius;
    double discriminant = b * b - 4 * a * c;
    double t = discriminant < 0 ? INFINITY : (-b - sqrt(discriminant)) / (2 * a);
    return t > 1e-9 ? t : INFINITY;
}

static const struct scene_object *textbook_hit(const struct scene *scene, const double origin[3],
                                               const double direction[3], double *distance)
{
    const struct scene_object *nearest = NULL;
    *distance = INFINITY;
    for (size_t i = 0; i < scene->object_count; ++i) {
        double t = textbook_distance(&scene->objects[i], origin, direction);
        if (t < *distance) {
            *distance = t;
            nearest = &scene->objects[i];
        }
    }
    return nearest;
}

struct textbook_pixel {
    const struct scene_object *object;
    bool lit;
    double irradiance_factor; /* radiance per unit of albedo */
};

/* What point (x, y) of figure 2(a)'s picture shows: camera at (0, 2, -6) looking along +z, so +x is on the
 * left. */
static struct textbook_pixel textbook_pixel(const struct scene *scene, double x, double y)
{
    const double eye[3] = {0, 2, -6};
    double half_height = tan(30 * pi / 180);
    double direction[3] = {-(x - 300) / 200 * half_height, -(y - 200) / 200 * half_height, 1};
    double distance, blocked_at;
    struct textbook_pixel pixel = {textbook_hit(scene, eye, direction, &distance), false, 0};
    if (!pixel.object)
        return pixel;
    double normal[3], to_light[3], to_eye[3], point[3], squared = 0, scale = 0, eye_scale = 0, cosine = 0;
    for (int i = 0; i < 3; ++i) {
        point[i] = eye[i] + distance * direction[i];
        to_light[i] = scene->lights[0].point.position[i] - point[i];
        to_eye[i] = -direction[i];
        normal[i] = pixel.object->type == OBJECT_PLANE ? pixel.object->plane.normal[i]
                                                       : point[i] - pixel.object->sphere.center[i];
        squared += to_light[i] * to_light[i];
        eye_scale += direction[i] * direction[i];
        scale += normal[i] * normal[i];
    }
    const double from_light[3] = {-to_light[0], -to_light[1], -to_light[2]};
    const struct scene_object *met =
        textbook_hit(scene, scene->lights[0].point.position, from_light, &blocked_at);
    for (int i = 0; i < 3; ++i) {
        normal[i] /= sqrt(scale);
        to_light[i] /= sqrt(squared);
        to_eye[i] /= sqrt(eye_scale);
        cosine += normal[i] * to_light[i];
    }
    pixel.lit = cosine > 0 && met == pixel.object && blocked_at > 1 - 1e-6;
    if (pixel.lit)
        pixel.irradiance_factor = oren_nayar_by_angles(normal, to_light, to_eye,
                                                       scene->materials[pixel.object->material].roughness) *
                                  scene->lights[0].power * cosine / squared;
    return pixel;
}

/* Every pixel of figure 2(a), roughness 0.6, that has no edge of an object or shadow within a hundredth of a
 * pixel of its centre, against the formula above. */
static void oren_nayar_whole_picture(void **state)
{
    (void)state;
    struct scene scene = test_read("scenes/figure_2a.yaml");
    int compared = 0, rough_term = 0;
    for (int renderer = TEST_DEVICE; renderer <= TEST_DOUBLE; ++renderer) {
        struct rendering rendering =
            test_render_scene(&scene, (enum test_renderer)renderer, (struct window){0});
        for (unsigned y = 0; y < scene.height; ++y)
            for (unsigned x = 0; x < scene.width; ++x) {
                struct textbook_pixel expected = textbook_pixel(&scene, x + 0.5, y + 0.5);
                bool near_edge = false;
                for (int k = 0; k < 4; ++k) {
                    struct textbook_pixel near = textbook_pixel(&scene, x + 0.5 + (k & 1 ? 0.01 : -0.01),
                                                                y + 0.5 + (k & 2 ? 0.01 : -0.01));
                    near_edge = near_edge || near.object != expected.object || near.lit != expected.lit;
                }
                if (near_edge)
                    continue;
                ++compared;
                rough_term += expected.irradiance_factor > 0;
                for (unsigned c = 0; c < 3; ++c) {
                    char what[64];
                    double albedo = scene.materials[expected.object->material].color[c];
                    snprintf(what, sizeof what, "pixel (%u, %u), channel %u, %s", x, y, c,
                             test_renderer_names[renderer]);
                    assert_near((double)rendering.image.rgb[((size_t)y * scene.width + x) * 3 + c],
                                albedo * expected.irradiance_factor, what);
                }
            }
        image_destroy(&rendering.image);
    }
    scene_destroy(&scene);
    assert_true(compared > 3 * 600 * 400 * 99 / 100);
    assert_true(rough_term > compared / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lambert_figures),
        cmocka_unit_test(oren_nayar_whole_picture),
    };
    return cmocka_run_group_tests(tests, test_open_device, test_close_device);
}
