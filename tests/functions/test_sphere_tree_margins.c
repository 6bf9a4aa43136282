/* The error analysis with the reference's tree of spheres against that of all of them: what the tree leaves
 * out has a margin of 1 at least. */
#include "../cmocka_test.h"

#include "hostile_spheres.h"
#include "light_margin.h"

#ifndef CASES
#define CASES 500000
#endif

enum { RAYS_A_SCENE = 16 };

/* Counts cases by the margin without the tree. */
struct count {
    long unsafe, wrong;
};

/* What is at least 1 may be any such margin. */
static void compare(struct count *count, double margin, double expected, const char *what, int scene, int k)
{
    bool right = expected < 1 ? margin == expected : margin >= 1;
    count->unsafe += expected < 1;
    if (!right && ++count->wrong < 10)
        print_error("%s %d of scene %d: margin %.9g, not %.9g\n", what, k, scene, margin, expected);
}

static void test_hits(void **state)
{
    struct count count = {0};
    (void)state;
    for (uint64_t i = 0; i < CASES / RAYS_A_SCENE; ++i) {
        struct random random = random_start(13, 0, i);
        struct hostile_scene scene;
        hostile_scene_create(&random, 0, &scene);
        for (int k = 0; k < RAYS_A_SCENE; ++k) {
            hostile_scene_blur(&random, &scene);
            struct ray ray = hostile_ray(&random, &scene);
            struct ray_error error = {scene.e_origin, scene.e_direction};
            struct hit hit;
            find_hit(&scene.without, &ray, &hit);
            compare(&count, hit_margin(&scene.with_tree, &ray, error, &hit),
                    hit_margin(&scene.without, &ray, error, &hit), "ray", (int)i, k);
        }
        hostile_scene_destroy(&scene);
    }
    print_message("%d rays, %ld with a margin below 1: %ld are others with the tree\n", CASES, count.unsafe,
                  count.wrong);
    assert_true(count.unsafe > CASES / 8 && count.unsafe < CASES / 8 * 7);
    assert_int_equal(count.wrong, 0);
}

static void test_shadows(void **state)
{
    struct count count = {0};
    (void)state;
    for (uint64_t i = 0; i < CASES / RAYS_A_SCENE; ++i) {
        struct random random = random_start(14, 0, i);
        struct hostile_scene scene;
        hostile_scene_create(&random, 0, &scene);
        for (int k = 0; k < RAYS_A_SCENE; ++k) {
            hostile_scene_blur(&random, &scene);
            struct segment segment = hostile_segment(&random, &scene);
            bool hides, expected;
            struct ray_error error = {scene.e_origin, scene.e_direction};
            double margin = shadow_margin(&scene.with_tree, &segment, error, &hides);
            double expected_margin = shadow_margin(&scene.without, &segment, error, &expected);
            assert_int_equal(hides, expected);
            if (hides)
                assert_true(margin == expected_margin);
            compare(&count, margin, expected_margin, "segment", (int)i, k);
        }
        hostile_scene_destroy(&scene);
    }
    print_message("%d segments, %ld with a margin below 1: %ld are others with the tree\n", CASES,
                  count.unsafe, count.wrong);
    assert_true(count.unsafe > CASES / 8 && count.unsafe < CASES / 8 * 7);
    assert_int_equal(count.wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hits), cmocka_unit_test(test_shadows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
