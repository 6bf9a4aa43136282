/* What scene_warn() says of a scene, and of which scenes it says nothing. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "npy_file.h"
#include "scene/warnings.h"
#include "test_folder.h"
#include "test_render.h"

#define HEAD TEST_SCENE_HEAD "  - { name: Air, type: transparent, ior: 0.6667 }\n"

#define OVERLAP(place, a, b, others) OVERLAP_OF(place, "\"" a "\"", "\"" b "\"", others)
#define OVERLAP_OF(place, a, b, others)                                                                      \
    "vkwhitted: warning: a.yaml:" place ": transparent bodies " a " and " b " overlap" others                \
    ", which the model does not cover; a body wholly inside another is no mistake, if its ior is relative "  \
    "to that "                                                                                               \
    "one's (air in glass: 1/1.5)"
#define SWAP(place)                                                                                          \
    "vkwhitted: warning: a.yaml:" place                                                                      \
    ": quad light shines away from every matte surface; swap u and v to turn it round"

/* expected: the one warning, or "". */
static void check_warning(const char *objects_and_lights, const char *expected)
{
    char text[4096], line[256];
    struct scene scene;
    snprintf(text, sizeof text, "%s%s", HEAD, objects_and_lights);
    assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &scene), STATUS_DONE);
    struct packed_scene packed = test_pack(&scene, test_settings(&scene));
    test_messages_begin();
    scene_warn(&scene, &packed);
    assert_int_equal(test_messages_end(line), expected[0] ? 1 : 0);
    test_messages[strcspn(test_messages, "\n")] = '\0';
    assert_string_equal(test_messages, expected);
    pack_destroy(&packed);
    scene_destroy(&scene);
}

static void spheres_that_cross(void **state)
{
    (void)state;
    check_warning("objects:\n"
                  "  - { name: A, type: sphere, center: [0, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [1, 0, 4], radius: 1, material: Air }\n",
                  OVERLAP("10:5", "A", "B", ""));
    check_warning("objects:\n"
                  "  - { name: A, type: sphere, center: [0, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [0.5, 0, 4], radius: 0.51, material: Air }\n",
                  OVERLAP("10:5", "A", "B", ""));
    check_warning(
        "objects:\n" /* in float the large one ends below the small one */
        "  - { name: A, type: sphere, center: [0, -1000003.73, 0], radius: 1000000.7, material: Glass }\n"
        "  - { name: B, type: sphere, center: [0, -2.05, 0], radius: 1, material: Glass }\n",
        OVERLAP("10:5", "A", "B", ""));
    check_warning("objects:\n" /* twice the same */
                  "  - { name: A, type: sphere, center: [0.1, 0.2, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [0.1, 0.2, 4], radius: 1, material: Glass }\n",
                  OVERLAP("10:5", "A", "B", ""));
}

/* Wherever they stand: the first pair is the one that is complete first in the file. */
static void one_warning_for_many(void **state)
{
    (void)state;
    check_warning("objects:\n"
                  "  - { name: A, type: sphere, center: [9, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [6, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: C, type: sphere, center: [3, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: D, type: sphere, center: [7.5, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: E, type: sphere, center: [2, 0, 4], radius: 1, material: Glass }\n",
                  OVERLAP("12:5", "A", "D", " (and 2 other pairs)"));
    check_warning("objects:\n"
                  "  - { name: P, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Glass }\n"
                  "  - { name: S, type: sphere, center: [0, 0, 5.5], radius: 1, material: Glass }\n"
                  "  - { name: Q, type: plane, point: [0, 0, 9], normal: [0, 1, 1], material: Glass }\n",
                  OVERLAP("10:5", "P", "S", " (and 1 other pair)"));
}

static void planes_that_cross(void **state)
{
    (void)state;
    check_warning("objects:\n"
                  "  - { name: A, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Glass }\n"
                  "  - { name: B, type: plane, point: [0, 4, 0], normal: [0, -1, 0.5], material: Glass }\n",
                  OVERLAP("10:5", "A", "B", ""));
    check_warning("objects:\n" /* twice the same */
                  "  - { name: A, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Glass }\n"
                  "  - { name: B, type: plane, point: [3, 4, 5], normal: [0, 0, -7], material: Glass }\n",
                  OVERLAP("10:5", "A", "B", ""));
    check_warning("objects:\n" /* a bubble that breaks through the surface of water */
                  "  - { name: A, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Glass }\n"
                  "  - { name: B, type: sphere, center: [0, 0, 5.9], radius: 1, material: Air }\n",
                  OVERLAP("10:5", "A", "B", ""));
}

static void bodies_inside_bodies(void **state)
{
    (void)state;
    check_warning("objects:\n" /* a bubble in a ball, a ball in that, a bubble in water */
                  "  - { name: A, type: sphere, center: [0, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [0.1, 0, 4], radius: 0.5, material: Air }\n"
                  "  - { name: C, type: sphere, center: [0.1, 0, 4], radius: 0.2, material: Glass }\n"
                  "  - { name: D, type: plane, point: [0, -2, 0], normal: [0, 1, 0], material: Glass }\n"
                  "  - { name: E, type: sphere, center: [0, -4, 0], radius: 1, material: Air }\n",
                  "");
    check_warning("objects:\n" /* touching, from without and within; opaque in glass */
                  "  - { name: A, type: sphere, center: [0, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: B, type: sphere, center: [2, 0, 4], radius: 1, material: Glass }\n"
                  "  - { name: C, type: sphere, center: [0.4, 0, 4], radius: 0.6, material: Air }\n"
                  "  - { name: D, type: sphere, center: [0, 0.6, 4], radius: 0.5, material: Mirror }\n"
                  "  - { name: E, type: plane, point: [0, -1, 0], normal: [0, 1, 0], material: Glass }\n"
                  "  - { name: F, type: plane, point: [0, -1, 0], normal: [0, 1, 0], material: Matte }\n",
                  "");
}

/* A pane is what is behind two planes that look away from each other. */
static void panes(void **state)
{
    (void)state;
    for (int count = 2; count <= 8; count *= 2) {
        char text[4096] = "objects:\n";
        for (int i = 0; i < count; ++i)
            snprintf(
                text + strlen(text), sizeof text - strlen(text),
                "  - { name: F%d, type: plane, point: [0, 0, %g], normal: [1, 2, -1], material: Glass }\n"
                "  - { name: B%d, type: plane, point: [0, 0, %g], normal: [-1, -2, 1], material: Glass }\n",
                i, 1 + 0.4 * i, i, 1.1 + 0.4 * i);
        check_warning(text, "");
    }
}

/* Expects a warning of these rows, in a moment. */
static void check_rows(float (*rows)[4], size_t count, const char *expected)
{
    npy_write("rows.npy", count, rows);
    clock_t start = clock();
    check_warning("objects:\n  - { name: Cloud, type: spheres, file: rows.npy, material: Glass }\n",
                  expected);
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 5);
}

/* A grid of 27,000 spheres of glass with a bubble in each, of which one crosses. */
static void many_spheres(void **state)
{
    (void)state;
    enum { SIDE = 30, COUNT = 2 * SIDE * SIDE * SIDE };
    static float rows[COUNT][4];
    for (int i = 0; i < COUNT; ++i) {
        const int cell = i / 2, place[3] = {cell % SIDE, cell / SIDE % SIDE, cell / SIDE / SIDE};
        for (int c = 0; c < 3; ++c)
            rows[i][c] = (float)place[c];
        rows[i][3] = i % 2 ? 0.25F : 0.5F;
    }
    rows[COUNT - 1][0] += 0.74F; /* so that only its edge is in the box of the other */
    check_rows(rows, COUNT, OVERLAP_OF("9:5", "\"Cloud\" row 53998", "\"Cloud\" row 53999", ""));
}

/* A row is named by its number; nothing is said of those that only touch. */
static void rows_of_a_file(void **state)
{
    static float rows[][4] = {{0, 0, 4, 1}, {2, 0, 4, 1}, {9, 0, 4, 1}, {4, 0, 4, 1}, {4.5, 0, 4, 1}};
    (void)state;
    npy_write("rows.npy", 4, rows);
    check_warning("objects:\n  - { name: Flake, type: spheres, file: rows.npy, material: Glass }\n", "");
    check_warning("objects:\n"
                  "  - { name: Flake, type: spheres, file: rows.npy, material: Glass }\n"
                  "  - { name: A, type: sphere, center: [9, 1, 4], radius: 0.5, material: Glass }\n"
                  "  - { name: P, type: plane, point: [0, 0, 5], normal: [0, 0, -1], material: Glass }\n",
                  OVERLAP_OF("10:5", "\"Flake\" row 2", "\"A\"", ""));
    npy_write("rows.npy", 5, rows);
    check_warning("objects:\n  - { name: Flake, type: spheres, file: rows.npy, material: Glass }\n",
                  OVERLAP_OF("9:5", "\"Flake\" row 3", "\"Flake\" row 4", ""));
    check_warning("objects:\n  - { name: Flake, type: spheres, file: rows.npy, material: Mirror }\n", "");
    check_warning("objects:\n"
                  "  - { name: P, type: plane, point: [0, 0, 4.5], normal: [0, 0, -1], material: Glass }\n"
                  "  - { name: Flake, type: spheres, file: rows.npy, material: Glass }\n",
                  OVERLAP_OF("10:5", "\"P\"", "\"Flake\" row 0", " (and 5 other pairs)"));
}

/* Fifty thousand spheres in one place overlap in a billion pairs, of which a thousand are counted. */
static void dense_cloud(void **state)
{
    (void)state;
    enum { COUNT = 50000 };
    static float rows[COUNT][4];
    srand48(1);
    for (int i = 0; i < COUNT; ++i) {
        rows[i][0] = (float)(i < 7 ? 10 * i : drand48());
        rows[i][3] = 1;
    }
    check_rows(rows, COUNT,
               OVERLAP_OF("9:5", "\"Cloud\" row 0", "\"Cloud\" row 7", " (and at least 999 other pairs)"));
}

#define FLOOR                                                                                                \
    "objects:\n  - { name: Floor, type: plane, point: [0, 0, 0], normal: [0, 1, 0], material: Matte }\n"
#define AND_SPHERE(y, radius, material)                                                                      \
    "  - { name: S, type: sphere, center: [0, " y ", 4], radius: " radius ", material: " material " }\n"
#define AND_PLANE(point, normal)                                                                             \
    "  - { name: P, type: plane, point: " point ", normal: " normal ", material: Matte }\n"
#define UP "  - { type: quad, corner: [-1, 2, -1], u: [1, 0, 0], v: [0, 0, 1], power: 10 }\n"
#define DOWN "  - { type: quad, corner: [-1, 2, -1], u: [0, 0, 1], v: [1, 0, 0], power: 10 }\n"

static void lights_that_shine_away(void **state)
{
    (void)state;
    check_warning(FLOOR "lights:\n" UP, SWAP("11:5"));
    check_warning(FLOOR "lights:\n" DOWN, "");
    check_warning(FLOOR "lights:\n" DOWN UP UP UP, SWAP("12:5"));
    check_warning(FLOOR AND_SPHERE("0", "1.9", "Matte") "lights:\n" UP, SWAP("12:5"));
    check_warning(FLOOR AND_SPHERE("9", "1", "Mirror") "lights:\n" UP, SWAP("12:5"));
    /* something to shine on: a sphere that reaches up, a ceiling, a wall; or nothing on either side */
    check_warning(FLOOR AND_SPHERE("0", "2.1", "Matte") "lights:\n" UP, "");
    check_warning(FLOOR AND_PLANE("[0, 3, 0]", "[0, 1, 0]") "lights:\n" UP, "");
    check_warning(FLOOR AND_PLANE("[0, 0, 8]", "[0, 0, 1]") "lights:\n" UP, "");
    check_warning("objects: []\nlights:\n" UP, "");
    static float rows[][4] = {{0, 1, 0, 0.5}, {0, -5, 0, 1}, {0, 3, 0, 1.5}};
    const char *cloud = FLOOR "  - { name: C, type: spheres, file: rows.npy, material: Matte }\nlights:\n" UP;
    npy_write("rows.npy", 2, rows);
    check_warning(cloud, SWAP("12:5"));
    npy_write("rows.npy", 3, rows);
    check_warning(cloud, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_that_cross),
        cmocka_unit_test(one_warning_for_many),
        cmocka_unit_test(planes_that_cross),
        cmocka_unit_test(bodies_inside_bodies),
        cmocka_unit_test(panes),
        cmocka_unit_test(many_spheres),
        cmocka_unit_test(rows_of_a_file),
        cmocka_unit_test(dense_cloud),
        cmocka_unit_test(lights_that_shine_away),
    };
    return cmocka_run_group_tests(tests, test_folder_setup, test_folder_teardown);
}
