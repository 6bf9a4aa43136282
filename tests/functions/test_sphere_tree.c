/* The reference with its tree of spheres against the reference that tries all of them, on purpose where
 * roundings decide: the same in every bit. */
#include "../cmocka_test.h"

#include <string.h>

#include "geometry.h"
#include "hostile_spheres.h"

#ifndef CASES
#define CASES 1000000
#endif

enum { RAYS_A_SCENE = 16 };

static bool same_hit(const struct hit *a, const struct hit *b)
{
    return a->surface == b->surface && a->from_inside == b->from_inside &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0;
}

static void test_hits(void **state)
{
    long wrong = 0, met = 0, inside = 0;
    (void)state;
    for (uint64_t i = 0; i < CASES / RAYS_A_SCENE; ++i) {
        struct random random = random_start(11, REFERENCE_BITS, i);
        struct hostile_scene scene;
        hostile_scene_create(&random, 0, &scene);
        for (int k = 0; k < RAYS_A_SCENE; ++k) {
            struct ray ray = hostile_ray(&random, &scene);
            struct hit expected, hit;
            bool meets = find_hit(&scene.without, &ray, &expected);
            met += meets;
            inside += meets && expected.from_inside;
            if (find_hit(&scene.with_tree, &ray, &hit) == meets && same_hit(&hit, &expected))
                continue;
            if (++wrong < 10)
                print_error("case %d of scene %d: surface %d at %.9g, not %d at %.9g\n", k, (int)i,
                            hit.surface, (double)hit.distance, expected.surface, (double)expected.distance);
        }
        hostile_scene_destroy(&scene);
    }
    print_message("%d rays, %ld hits, %ld of them from inside: %ld are others with the tree\n", CASES, met,
                  inside, wrong);
    assert_true(met > CASES / 4 && inside > CASES / 32);
    assert_int_equal(wrong, 0);
}

static void test_shadows(void **state)
{
    long wrong = 0, blocked = 0;
    (void)state;
    for (uint64_t i = 0; i < CASES / RAYS_A_SCENE; ++i) {
        struct random random = random_start(12, REFERENCE_BITS, i);
        struct hostile_scene scene;
        hostile_scene_create(&random, 0, &scene);
        for (int k = 0; k < RAYS_A_SCENE; ++k) {
            struct segment segment = hostile_segment(&random, &scene);
            bool expected = is_blocked(&scene.without, &segment);
            blocked += expected;
            if (is_blocked(&scene.with_tree, &segment) != expected && ++wrong < 10)
                print_error("case %d of scene %d: %sblocked\n", k, (int)i, expected ? "not " : "");
        }
        hostile_scene_destroy(&scene);
    }
    print_message("%d segments, %ld blocked: %ld are not as without the tree\n", CASES, blocked, wrong);
    assert_true(blocked > CASES / 4 && blocked < CASES / 4 * 3);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hits), cmocka_unit_test(test_shadows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
