/* What must hold exactly, or nearly so, whatever the numbers are: scaling, mirroring, conservation of energy.
 */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>

#include "test_render.h"

static const double unit_roundoff = 0x1p-24; /* float's */

static void assert_same_bits(const struct rendering *a, const struct rendering *b, const char *what,
                             const char *renderer)
{
    assert_int_equal(a->image.width, b->image.width);
    assert_int_equal(a->image.height, b->image.height);
    for (size_t i = 0; i < (size_t)3 * a->image.width * a->image.height; ++i) {
        if (memcmp(a->image.rgb + i, b->image.rgb + i, sizeof *a->image.rgb) == 0)
            continue;
        size_t pixel = i / 3;
        print_error("%s, %s: pixel (%zu, %zu): %.9g and %.9g\n", what, renderer, pixel % a->image.width,
                    pixel / a->image.width, (double)a->image.rgb[i], (double)b->image.rgb[i]);
        fail();
    }
    assert_memory_equal(&a->rays, &b->rays, sizeof a->rays);
}

/* Every length times 2^20 or 2^-20, the light's power times the square: no rounding changes. */
static void scaled_by_powers_of_two(void **state)
{
    (void)state;
    static const char *const names[] = {"scenes/hard/scaled_up.yaml", "scenes/hard/scaled_down.yaml"};
    struct scene figure = test_read("scenes/figure_4.yaml");
    for (int i = 0; i < 2; ++i) {
        struct scene scaled = test_read(names[i]);
        figure.width = scaled.width;
        figure.height = scaled.height;
        for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
            struct rendering as_is =
                test_render_scene(&figure, (enum test_renderer)renderer, (struct window){0});
            struct rendering other =
                test_render_scene(&scaled, (enum test_renderer)renderer, (struct window){0});
            assert_same_bits(&as_is, &other, names[i], test_renderer_names[renderer]);
            image_destroy(&as_is.image);
            image_destroy(&other.image);
        }
        scene_destroy(&scaled);
    }
    scene_destroy(&figure);
}

static void mirror_scene(struct scene *scene)
{
    for (size_t i = 0; i < scene->object_count; ++i) {
        struct scene_object *object = &scene->objects[i];
        if (object->type == OBJECT_SPHERE) {
            object->sphere.center[0] = -object->sphere.center[0];
        } else {
            object->plane.point[0] = -object->plane.point[0];
            object->plane.normal[0] = -object->plane.normal[0];
        }
    }
    for (size_t i = 0; i < scene->light_count; ++i)
        scene->lights[i].point.position[0] = -scene->lights[i].point.position[0];
}

static void swap_left_and_right(struct image *image)
{
    for (unsigned y = 0; y < image->height; ++y)
        for (unsigned x = 0; x < image->width / 2; ++x) {
            float *left = image->rgb + 3 * ((size_t)y * image->width + x);
            float *right = image->rgb + 3 * ((size_t)y * image->width + image->width - 1 - x);
            float pixel[3];
            memcpy(pixel, left, sizeof pixel);
            memcpy(left, right, sizeof pixel);
            memcpy(right, pixel, sizeof pixel);
        }
}

/* A scene with point lights, seen by a camera in the plane x = 0, and its mirror image in that plane: all x
 * only change sign, which rounds nothing differently. */
static void mirrored(void **state)
{
    (void)state;
    static const char *const names[] = {"scenes/figure_4.yaml", "scenes/hard/bubble.yaml",
                                        "scenes/hard/thin_shell.yaml"};
    for (int i = 0; i < 3; ++i)
        for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
            struct scene scene = test_read(names[i]);
            scene.width = 151;
            scene.height = 100;
            struct rendering as_is =
                test_render_scene(&scene, (enum test_renderer)renderer, (struct window){0});
            mirror_scene(&scene);
            struct rendering other =
                test_render_scene(&scene, (enum test_renderer)renderer, (struct window){0});
            swap_left_and_right(&other.image);
            assert_same_bits(&as_is, &other, names[i], test_renderer_names[renderer]);
            image_destroy(&as_is.image);
            image_destroy(&other.image);
            scene_destroy(&scene);
        }
}

enum { BOUNCES = 64, WIDTH = 150, HEIGHT = 100 };
static const float background[3] = {1, 0.5f, 0.25f};

static struct rendering render_furnace(enum material_type type, double ior, enum test_renderer renderer)
{
    struct scene scene = test_read("tests/scenes/furnace.yaml");
    scene.materials[0].type = type;
    scene.materials[0].ior = ior;
    struct rendering rendering = test_render_scene(&scene, renderer, (struct window){0});
    scene_destroy(&scene);
    return rendering;
}

/* One ray a pixel, of weight 1: 0 + 1 * background rounds nothing, so the ball cannot be told from nothing.
 */
static void mirror_ball_is_invisible(void **state)
{
    (void)state;
    for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
        struct rendering rendering = render_furnace(MATERIAL_MIRROR, 1, (enum test_renderer)renderer);
        assert_true(rendering.rays.secondary > WIDTH * HEIGHT / 5);
        for (size_t i = 0; i < WIDTH * HEIGHT; ++i)
            assert_memory_equal(rendering.image.rgb + 3 * i, background, sizeof background);
        image_destroy(&rendering.image);
    }
}

/* Distance of pixel (x, y)'s ray from the centre of furnace.yaml's ball, whose radius is 1: the sine of the
 * angle of incidence. */
static double sine_of_incidence(unsigned x, unsigned y)
{
    static const double position[3] = {0.3, 0.2, -4}, look_at[3] = {0.1, 0, 0};
    double forward[3], right[3], down[3], d[3], size = 0;
    for (int i = 0; i < 3; ++i)
        size += (look_at[i] - position[i]) * (look_at[i] - position[i]);
    for (int i = 0; i < 3; ++i)
        forward[i] = (look_at[i] - position[i]) / sqrt(size);
    double across = sqrt(forward[0] * forward[0] + forward[2] * forward[2]); /* forward x (0, 1, 0) */
    right[0] = -forward[2] / across;
    right[1] = 0;
    right[2] = forward[0] / across;
    down[0] = forward[1] * right[2] - forward[2] * right[1];
    down[1] = forward[2] * right[0] - forward[0] * right[2];
    down[2] = forward[0] * right[1] - forward[1] * right[0];
    double half_pixel = tan(20 * 3.14159265358979323846 / 180) / HEIGHT;
    for (int i = 0; i < 3; ++i)
        d[i] =
            forward[i] + half_pixel * ((2.0 * x + 1 - WIDTH) * right[i] + (2.0 * y + 1 - HEIGHT) * down[i]);
    double cross[3] = {position[1] * d[2] - position[2] * d[1], position[2] * d[0] - position[0] * d[2],
                       position[0] * d[1] - position[1] * d[0]};
    return sqrt((cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) /
                (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
}

/* Fresnel's k_r for a ball of this index, inside and outside the same; 1 where there is no refracted ray or
 * no ball. */
static double fresnel(double sine, double ior)
{
    if (sine >= 1 || sine >= ior)
        return 1;
    double cos_in = sqrt(1 - sine * sine), cos_out = sqrt(1 - sine * sine / (ior * ior));
    double r_s = (cos_in - ior * cos_out) / (cos_in + ior * cos_out);
    double r_p = (ior * cos_in - cos_out) / (ior * cos_in + cos_out);
    return (r_s * r_s + r_p * r_p) / 2;
}

/* The part of the light that the limit of bounces cuts off: refracted in, then kept inside by every
 * reflection but the last, which is not made. */
static double part_lost(double reflectance)
{
    return (1 - reflectance) * pow(reflectance, BOUNCES - 1);
}

/* The direction's error after 64 hits of about 4 roundings each: what the sine of incidence may be off. */
static const double sine_error = 4 * BOUNCES * 0x1p-24;

static double lost_error(double sine, double ior)
{
    double lost = part_lost(fresnel(sine, ior)), least = lost, most = lost;
    for (int i = -16; i <= 16; ++i) { /* may rise and fall on the way */
        double near = part_lost(fresnel(sine + sine_error * i / 16, ior));
        least = fmin(least, near);
        most = fmax(most, near);
    }
    return most - least;
}

/* A split of weight w into fl(w fl(1 - R)) and fl(w R) keeps w up to 2 w roundoffs; the weights that are
 * split sum to 1 outside and (1 - R) (1 + R + R^2 + ...) <= 1 inside: 4 roundoffs. Each part that leaves is
 * multiplied and added: 1 roundoff of the sum together, and one each while the parts are above a roundoff;
 * the tail of those that are smaller is 1 more. */
static double rounding_error(double reflectance)
{
    int parts = 1;
    double part = (1 - reflectance) * (1 - reflectance);
    for (; parts < BOUNCES + 1 && part > unit_roundoff * (1 - reflectance); ++parts)
        part *= reflectance;
    return (4 + 1 + parts + 1) * unit_roundoff;
}

static size_t check_energy(const struct rendering *rendering, double ior, const char *renderer)
{
    size_t balls = 0;
    for (unsigned y = 0; y < HEIGHT; ++y)
        for (unsigned x = 0; x < WIDTH; ++x) {
            const float *rgb = rendering->image.rgb + ((size_t)y * WIDTH + x) * 3;
            double sine = sine_of_incidence(x, y), reflectance = fresnel(sine, ior);
            double expected = 1 - part_lost(reflectance);
            double bound = rounding_error(reflectance) + lost_error(sine, ior);
            balls += sine < 1 && bound < 2e-6;
            for (int c = 0; c < 3; ++c) {
                double part = (double)rgb[c] / (double)background[c];
                if (fabs(part - expected) <= bound)
                    continue;
                print_error(
                    "ior %g, %s: pixel (%u, %u) channel %d: %.9g of the light, expected %.9g +- %.2g\n", ior,
                    renderer, x, y, c, part, expected, bound);
                fail();
            }
        }
    return balls;
}

static void glass_ball_conserves_energy(void **state)
{
    (void)state;
    static const double iors[] = {1.5, 2.42, 0.75};
    for (int i = 0; i < 3; ++i)
        for (int renderer = 0; renderer < TEST_RENDERERS; ++renderer) {
            struct rendering rendering =
                render_furnace(MATERIAL_TRANSPARENT, iors[i], (enum test_renderer)renderer);
            size_t sharp = check_energy(&rendering, iors[i], test_renderer_names[renderer]);
            assert_true(sharp > WIDTH * HEIGHT / 5); /* most of the ball, to a few roundings */
            image_destroy(&rendering.image);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scaled_by_powers_of_two),
        cmocka_unit_test(mirrored),
        cmocka_unit_test(mirror_ball_is_invisible),
        cmocka_unit_test(glass_ball_conserves_energy),
    };
    return cmocka_run_group_tests(tests, test_open_device, test_close_device);
}
