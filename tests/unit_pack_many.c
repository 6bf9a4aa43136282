/* The packed scene of many spheres: which are looped over, in which order the others are, what they share,
 * and that their tags are those that comparing all with all finds. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/interrupt.h"
#include "npy_file.h"
#include "scene/body.h"
#include "scene/looped.h"
#include "test_folder.h"
#include "test_render.h"

#define HEAD TEST_SCENE_HEAD "objects:\n"

enum { MOST_ROWS = 1000 };

static float rows[MOST_ROWS][4];

/* Spheres of this radius that stand apart in a row. */
static void fill_rows(size_t count, float radius)
{
    for (size_t i = 0; i < count; ++i) {
        rows[i][0] = (float)i;
        rows[i][1] = 0;
        rows[i][2] = 8;
        rows[i][3] = radius;
    }
}

static struct packed_scene pack(const char *objects_and_lights, double max_error)
{
    struct scene scene;
    char text[8192];
    snprintf(text, sizeof text, "%s%s", HEAD, objects_and_lights);
    assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &scene), STATUS_DONE);
    struct picture_settings settings = test_settings(&scene);
    settings.has_max_error = max_error > 0;
    settings.max_error = max_error;
    struct packed_scene packed = test_pack(&scene, settings);
    scene_destroy(&scene);
    return packed;
}

#define CLOUD "  - { name: Cloud, type: spheres, file: rows.npy, material: Mirror }\n"

/* A few are looped over, rows or not; with one more none is, and there is a hierarchy of them. */
static void few_and_many(void **state)
{
    (void)state;
    for (int count = MOST_LOOPED - 1; count <= MOST_LOOPED; ++count) {
        fill_rows((size_t)count, 0.25F);
        npy_write("rows.npy", (size_t)count, rows);
        struct packed_scene packed = pack(
            CLOUD "  - { name: Ball, type: sphere, center: [0, 3, 4], radius: 1, material: Glass }\n", 0);
        const bool many = count + 1 > MOST_LOOPED;
        assert_int_equal(packed.sphere_count, count + 1);
        assert_int_equal(packed.looped_spheres, many ? 0 : count + 1);
        assert_int_equal(packed.surface_count, many ? 2 : count + 1);
        assert_true(many == (packed.hierarchy != NULL));
        if (many)
            assert_int_equal(packed.hierarchy->node_count, 2 * (count + 1) - 1);
        pack_destroy(&packed);
        assert_null(packed.hierarchy);
    }
}

/* Rows pack to the bits of the same spheres in the scene file. */
static void rows_as_objects(void **state)
{
    (void)state;
    char text[8192] = "";
    fill_rows(MOST_LOOPED, 0.25F);
    rows[7][3] = 0.6F; /* cuts its neighbours, and is not what 0.6 is in double */
    rows[8][1] = 0.1F;
    npy_write("rows.npy", MOST_LOOPED, rows);
    for (int i = 0; i < MOST_LOOPED; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "  - { name: S%d, type: sphere, center: [%g, %g, 8], radius: %g, material: Glass }\n", i,
                 (double)rows[i][0], (double)rows[i][1], (double)rows[i][3]);
    struct packed_scene objects = pack(text, 0);
    struct packed_scene packed =
        pack("  - { name: Cloud, type: spheres, file: rows.npy, material: Glass }\n", 0);
    assert_int_equal(packed.sphere_count, objects.sphere_count);
    assert_int_equal(packed.looped_spheres, MOST_LOOPED);
    assert_memory_equal(packed.spheres, objects.spheres, MOST_LOOPED * sizeof *packed.spheres);
    assert_memory_equal(packed.surfaces, objects.surfaces, MOST_LOOPED * sizeof *packed.surfaces);
    assert_memory_equal(&packed.view, &objects.view, sizeof packed.view);
    pack_destroy(&packed);
    pack_destroy(&objects);
}

/* Each row counts in the order of the file; spheres of one object share its surface. */
static void order_and_surfaces(void **state)
{
    (void)state;
    fill_rows(30, 0.25F);
    npy_write("rows.npy", 30, rows);
    npy_write("none.npy", 0, rows);
    struct packed_scene packed =
        pack("  - { name: First, type: sphere, center: [0, 3, 4], radius: 1, material: Glass }\n"
             "  - { name: Floor, type: plane, point: [0, -3, 0], normal: [0, 1, 0], material: Matte }\n"
             "  - { name: None, type: spheres, file: none.npy, material: Glass }\n" CLOUD
             "  - { name: Wall, type: plane, point: [0, 0, 50], normal: [0, 0, 1], material: Matte }\n"
             "  - { name: Again, type: spheres, file: rows.npy, material: Matte }\n"
             "  - { name: Last, type: sphere, center: [0, 3, 9], radius: 1, material: Mirror }\n",
             0);
    static const int kinds[] = {KIND_TRANSPARENT, KIND_MIRROR, KIND_MATTE, KIND_MIRROR};
    assert_int_equal(packed.sphere_count, 62);
    assert_int_equal(packed.looped_spheres, 0);
    assert_int_equal(packed.surface_count, 4);
    for (int i = 0; i < 4; ++i)
        assert_int_equal(packed.surfaces[i].tags.SURFACE_KIND, kinds[i]);
    for (int i = 0; i < 62; ++i) { /* coincident ones are kept: the first of the file is met */
        const layout_ivec4 tags = packed.spheres[i].tags;
        assert_int_equal(tags.FILE_ORDER, i == 0 ? 0 : i < 31 ? i + 1 : i + 2);
        assert_int_equal(tags.SURFACE, i == 0 ? 0 : i < 31 ? 1 : i < 61 ? 2 : 3);
    }
    assert_int_equal(packed.planes[0].surface.tags.FILE_ORDER, 1);
    assert_int_equal(packed.planes[1].surface.tags.FILE_ORDER, 32);
    assert_true(packed.spheres[1].center_radius.x == packed.spheres[31].center_radius.x);
    assert_true(packed.view.matte.SHARED_A == packed.surfaces[2].parameters.OREN_NAYAR_A);
    pack_destroy(&packed);
}

static void check_large(float radius, float other, int expected)
{
    fill_rows(30, 0.25F);
    rows[3][3] = radius;
    rows[20][3] = other;
    npy_write("rows.npy", 30, rows);
    struct packed_scene packed = pack(CLOUD, 0);
    assert_int_equal(packed.looped_spheres, expected);
    assert_int_equal(packed.sphere_count, 30);
    assert_int_equal(packed.surface_count, expected + 1);
    for (int i = 0; i < 30; ++i) {
        const struct PackedSphere *sphere = &packed.spheres[i];
        assert_int_equal(sphere->tags.SURFACE, i < expected ? i : expected);
        assert_true(i == 0 || i == expected || sphere[0].tags.FILE_ORDER > sphere[-1].tags.FILE_ORDER);
    }
    if (expected > 0)
        assert_int_equal(packed.spheres[0].tags.FILE_ORDER, 3);
    if (expected > 1)
        assert_int_equal(packed.spheres[1].tags.FILE_ORDER, 20);
    pack_destroy(&packed);
}

/* The spheres stand in a row from -0.25 to 29.25, so that one is large from a diameter of 14.75 on. */
static void large_spheres(void **state)
{
    (void)state;
    check_large(0.25F, 0.25F, 0);
    check_large(7.3F, 0.25F, 0);
    check_large(7.4F, 0.25F, 1);
    check_large(1e5F, 0.25F, 1);
    check_large(1e5F, 1e6F, 2);
    check_large(7.4F, 7.5F, 2);
    check_large(1e5F, 7.3F, 1); /* it is not large, and so part of the box: from -0.25 to 29.25 still */
    fill_rows(30, 0.25F);
    for (size_t i = 0; i < 20; ++i) /* the first four are left to the hierarchy */
        rows[i][3] = 1e5F + (float)i;
    npy_write("rows.npy", 30, rows);
    struct packed_scene packed = pack(CLOUD, 0);
    assert_int_equal(packed.looped_spheres, MOST_LARGE);
    for (int i = 0; i < 30; ++i)
        assert_int_equal(packed.spheres[i].tags.FILE_ORDER, i < 16 ? i + 4 : i < 20 ? i - 16 : i);
    pack_destroy(&packed);
}

static bool reaches_in(const struct packed_scene *packed, int sphere)
{
    bool found = false;
    for (int i = 0; i < body_count(packed); ++i)
        found |= i != sphere && body_reaches_into(body_packed(packed, i), body_packed(packed, sphere));
    return found;
}

static bool has_light(const struct packed_scene *packed, int sphere)
{
    const struct body holder = body_packed(packed, sphere);
    const struct PackedQuadLight *quad = packed->quad_lights;
    struct dvec3 u = dvec3_of_vec4(quad->edge_u), v = dvec3_of_vec4(quad->edge_v);
    struct dvec3 middle = dvec3_add(dvec3_of_vec4(quad->corner), dvec3_scale(0.5, dvec3_add(u, v)));
    return body_distance(holder, dvec3_of_vec4(packed->point_lights->position)) < 0 ||
           body_distance(holder, middle) < (dvec3_length(u) + dvec3_length(v)) / 2;
}

static double uniform(double from, double to)
{
    return from + (to - from) * drand48();
}

/* Small ones and large ones, now and then a larger one; some touch one before from within or without. */
static void scatter(size_t i)
{
    float *row = rows[i];
    for (int c = 0; c < 3; ++c)
        row[c] = (float)uniform(-10, 10);
    row[3] = (float)pow(10, uniform(-1.5, 0.3));
    if (drand48() < 0.01)
        row[3] = 50;
    if (i > 0 && drand48() < 0.3) {
        const float *before = rows[i - 1];
        memcpy(row, before, 3 * sizeof *row);
        row[0] += before[3] + (drand48() < 0.5 ? row[3] : -row[3]);
    }
}

/* Tags as comparing all with all finds them. */
static void tags_of_random_scenes(void **state)
{
    int holders = 0, empty = 0, lit = 0, looped = 0;
    (void)state;
    for (int seed = 0; seed < 40; ++seed) {
        srand48(seed);
        for (size_t i = 0; i < 200; ++i)
            scatter(i);
        npy_write("glass.npy", 150, rows);
        npy_write("matte.npy", 50, rows + 150);
        struct packed_scene packed =
            pack("  - { name: Glass, type: spheres, file: glass.npy, material: Glass }\n"
                 "  - { name: Matte, type: spheres, file: matte.npy, material: Matte }\n"
                 "  - { name: Wall, type: plane, point: [0, 0, 8], normal: [0, 0.1, 1], material: Matte }\n"
                 "lights:\n"
                 "  - { type: point, position: [3, 1, 2], power: 1 }\n"
                 "  - { type: quad, corner: [-4, 2, -3], u: [2, 0, 0], v: [0, 0, 1], power: 1 }\n",
                 0);
        assert_int_equal(packed.sphere_count, 200);
        looped += packed.looped_spheres;
        for (int i = 0; i < 200; ++i) {
            const layout_ivec4 tags = packed.spheres[i].tags;
            const bool glass = body_surface(&packed, i)->tags.SURFACE_KIND == KIND_TRANSPARENT;
            const bool holds =
                body_distance(body_packed(&packed, i), dvec3_of_vec4(packed.view.position)) < 0 ||
                (glass && reaches_in(&packed, i));
            if ((tags.HOLDS_RAYS != 0) != holds || tags.HOLDS_LIGHTS != has_light(&packed, i))
                fail_msg("seed %d, sphere %d: tags %d, %d", seed, i, tags.HOLDS_RAYS, tags.HOLDS_LIGHTS);
            holders += holds;
            empty += glass && !holds;
            lit += tags.HOLDS_LIGHTS;
        }
        pack_destroy(&packed);
    }
    assert_true(holders > 1000 && empty > 1000 && lit > 20 && looped > 10); /* else it would prove little */
}

/* Rays escape between parallel mirrors where all spheres can be tried. */
static void escapes(void **state)
{
    (void)state;
    for (int count = MOST_LOOPED; count <= MOST_LOOPED + 1; ++count) {
        fill_rows((size_t)count, 0.25F);
        npy_write("rows.npy", (size_t)count, rows);
        struct packed_scene packed = pack(
            CLOUD "  - { name: A, type: plane, point: [-9, 0, 0], normal: [1, 0, 0], material: Mirror }\n"
                  "  - { name: B, type: plane, point: [90, 0, 0], normal: [1, 0, 0], material: Mirror }\n",
            1e-3);
        assert_true((packed.view.between_mirrors.w != 0) == (count <= MOST_LOOPED));
        pack_destroy(&packed);
    }
}

/* What is packed beside another camera's scene is as packed anew, but shares its hierarchy. */
static void moved_camera(void **state)
{
    (void)state;
    const char *text =
        HEAD "  - { name: Glass, type: spheres, file: glass.npy, material: Glass }\n"
             "  - { name: Wall, type: plane, point: [0, 0, 8], normal: [0, 0, 1], material: Matte }\n"
             "  - { name: Matte, type: spheres, file: matte.npy, material: Matte }\n";
    int changed = 0;
    for (int seed = 0; seed < 10; ++seed) {
        struct scene scene;
        struct packed_scene first, beside, anew;
        srand48(seed);
        for (size_t i = 0; i < 200; ++i)
            scatter(i);
        npy_write("glass.npy", 150, rows);
        npy_write("matte.npy", 50, rows + 150);
        assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &scene), STATUS_DONE);
        const struct picture_settings settings = test_settings(&scene);
        first = test_pack(&scene, settings);
        for (int c = 0; c < 3; ++c) /* to within a sphere, in half of the cases behind the wall */
            scene.camera.position[c] = (double)rows[seed][c] + (c == 2 && seed % 2 ? 30 : 0);
        assert_int_equal(pack_scene(&first, &scene, &settings, &beside), STATUS_DONE);
        anew = test_pack(&scene, settings);
        const int last = first.sphere_count - 1; /* is no giant */
        const bool same_scale = first.spheres[last].center_radius.w == anew.spheres[last].center_radius.w;
        assert_true((beside.hierarchy == first.hierarchy) == same_scale);
        const size_t size = (size_t)anew.sphere_count * sizeof *anew.spheres;
        assert_memory_equal(beside.spheres, anew.spheres, size);
        assert_memory_equal(beside.planes, anew.planes, sizeof *anew.planes);
        changed += memcmp(beside.spheres, first.spheres, size) != 0;
        pack_destroy(&first);
        assert_true(beside.hierarchy->owners == 1 && beside.hierarchy->nodes[0].left > 0);
        pack_destroy(&beside);
        pack_destroy(&anew);
        scene_destroy(&scene);
    }
    assert_true(changed > 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_and_many),  cmocka_unit_test(rows_as_objects),
        cmocka_unit_test(moved_camera),  cmocka_unit_test(order_and_surfaces),
        cmocka_unit_test(large_spheres), cmocka_unit_test(tags_of_random_scenes),
        cmocka_unit_test(escapes),
    };
    return cmocka_run_group_tests(tests, test_folder_setup, test_folder_teardown);
}
