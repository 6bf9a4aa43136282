#include "cmocka_test.h"

#include <stdio.h>
#include <string.h>

#include "base/escape.h"
#include "scene_capture.h"
#include "scenes_bad.h"

static void assert_empty(const struct scene *scene)
{
    static const struct scene empty;
    assert_memory_equal(scene, &empty, sizeof(empty));
}

static void assert_vector(const double v[3], double x, double y, double z)
{
    if (v[0] != x || v[1] != y || v[2] != z)
        fail_msg("[%g, %g, %g] instead of [%g, %g, %g]", v[0], v[1], v[2], x, y, z);
}

static size_t count_errors(void)
{
    size_t count = 0;
    for (const char *at = test_messages; (at = strstr(at, ": error: ")); at++)
        count++;
    return count;
}

/* The message with the line it is about and a caret below the column. */
static void expected_report(const char *text, const char *message, char *out, size_t size)
{
    int line, column;
    assert_int_equal(sscanf(message, "%d:%d", &line, &column), 2);
    for (int i = 1; i < line && strchr(text, '\n'); i++)
        text = strchr(text, '\n') + 1;
    char quoted[512] = "", shown[ESCAPED_SIZE];
    for (const char *end = text + strcspn(text, "\n"); text < end;) {
        text += escape_character(text, (size_t)(end - text), shown);
        strcat(quoted, strcmp(shown, "\\x09") == 0 ? "\t" : shown);
    }
    snprintf(out, size, "bad.yaml:%s\n%s\n%*s\n", message, quoted, column, "^");
}

static void test_bad_scenes(void **state)
{
    (void)state;
    const size_t count = sizeof(bad_scenes) / sizeof(bad_scenes[0]);
    size_t failed = 0;
    assert_true(count >= 60);
    for (size_t i = 0; i < count; i++) {
        char expected[1024];
        struct scene scene;
        expected_report(bad_scenes[i].text, bad_scenes[i].message, expected, sizeof(expected));
        enum status status = read_text(bad_scenes[i].text, &scene);
        if (status == STATUS_REFUSED && strcmp(test_messages, expected) == 0) {
            assert_empty(&scene);
            continue;
        }
        failed++;
        print_error("bad scene %zu, status %d, expected:\n%sfound:\n%s", i, (int)status, expected,
                    test_messages);
        scene_destroy(&scene);
    }
    assert_int_equal(failed, 0);
}

static void test_defaults(void **state)
{
    (void)state;
    struct scene scene;
    read_good("camera: { position: [1, 2, 3], look_at: [4, 5, 6] }\nimage: { width: 1, height: 65536 }\n",
              &scene);
    assert_string_equal(scene.path, "bad.yaml");
    assert_vector(scene.camera.position, 1, 2, 3);
    assert_vector(scene.camera.look_at, 4, 5, 6);
    assert_vector(scene.camera.up, 0, 1, 0);
    assert_true(scene.camera.fov_y_degrees == 60);
    assert_int_equal(scene.width, 1);
    assert_int_equal(scene.height, 65536);
    assert_vector(scene.background, 0, 0, 0);
    assert_int_equal(scene.max_bounces, 5);
    assert_int_equal(scene.light_samples, 32);
    assert_int_equal(scene.material_count + scene.object_count + scene.light_count, 0);
    scene_destroy(&scene);
    assert_empty(&scene);
    scene_destroy(&scene);

    read_good(
        HEAD
        "materials:\n  - { name: A, type: matte, color: [0, 0.5, 1] }\n  - { name: B, type: transparent }\n"
        "objects: []\nlights:\n"
        "  - { type: point, position: [0, 0, 0], power: 0 }\n",
        &scene);
    assert_true(scene.materials[0].roughness == 0);
    assert_vector(scene.materials[0].color, 0, 0.5, 1);
    assert_true(scene.materials[1].ior == 1.3);
    assert_vector(scene.lights[0].color, 1, 1, 1);
    scene_destroy(&scene);

    read_good("camera: { position: [0, 0, 0], look_at: [0, 0, 1e-10], up: [0, 1e-320, 0] }\n"
              "image: { width: 4, height: 4 }\n",
              &scene);
    scene_destroy(&scene);
    read_good("camera: { position: [0, 0, 0], look_at: [0, 0, 1e15], up: [0, 1e308, 0] }\n"
              "image: { width: 4, height: 4 }\n",
              &scene);
    scene_destroy(&scene);

    read_good(HEAD "materials:\nobjects:\nlights:\n", &scene);
    assert_int_equal(scene.material_count + scene.object_count + scene.light_count, 0);
    scene_destroy(&scene);
}

static const char every_field[] =
    "camera: { position: [1, 2, 3], look_at: [4, 5, -6], up: [7, 8, 9], fov_y: 33.5 }\n"
    "image: { width: 640, height: 480 }\n"
    "background: [0.1, 0.2, 300]\n"
    "max_bounces: 0\n"
    "light_samples: 65536\n"
    "objects:\n"
    "  - { name: 'Ball 1', type: sphere, center: [1, -2, 3e2], radius: 1e-15, material: Glass }\n"
    "  - name: Floor\n"
    "    type: plane\n"
    "    point: [-1e15, 0, 1e15]\n"
    "    normal: [0, 1e-320, 0]\n"
    "    material: \"Gr\\u00fcn\"\n"
    "materials:\n"
    "  - { name: Spiegel, type: mirror }\n"
    "  - { name: Gr\xC3\xBCn, type: matte, color: [0, 1, 0.25], roughness: 0.6 }\n"
    "  - { name: Glass, type: transparent, ior: 1.5 }\n"
    "lights:\n"
    "  - { type: quad, corner: [1, 5, -2], u: [-2, 0, 0], v: [0, 1, 2], color: [1, 2, 3], power: 40 }\n"
    "  - { type: point, position: [0, 5, 0], color: [0.5, 0.25, 0], power: 1e15 }\n";

static void test_every_field(void **state)
{
    (void)state;
    struct scene scene;
    read_good(every_field, &scene);
    assert_vector(scene.camera.position, 1, 2, 3);
    assert_vector(scene.camera.look_at, 4, 5, -6);
    assert_vector(scene.camera.up, 7, 8, 9);
    assert_true(scene.camera.fov_y_degrees == 33.5);
    assert_int_equal(scene.width, 640);
    assert_int_equal(scene.height, 480);
    assert_vector(scene.background, 0.1, 0.2, 300);
    assert_int_equal(scene.max_bounces, 0);
    assert_int_equal(scene.light_samples, 65536);

    assert_int_equal(scene.material_count, 3);
    assert_string_equal(scene.materials[0].name, "Spiegel");
    assert_int_equal(scene.materials[0].type, MATERIAL_MIRROR);
    assert_string_equal(scene.materials[1].name, "Gr\xC3\xBCn");
    assert_int_equal(scene.materials[1].type, MATERIAL_MATTE);
    assert_vector(scene.materials[1].color, 0, 1, 0.25);
    assert_true(scene.materials[1].roughness == 0.6);
    assert_int_equal(scene.materials[2].type, MATERIAL_TRANSPARENT);
    assert_true(scene.materials[2].ior == 1.5);

    assert_int_equal(scene.object_count, 2);
    assert_string_equal(scene.objects[0].name, "Ball 1");
    assert_int_equal(scene.objects[0].type, OBJECT_SPHERE);
    assert_int_equal(scene.objects[0].material, 2);
    assert_vector(scene.objects[0].sphere.center, 1, -2, 300);
    assert_true(scene.objects[0].sphere.radius == 1e-15);
    assert_int_equal(scene.objects[0].place.line, 7);
    assert_int_equal(scene.objects[0].place.column, 5);
    assert_string_equal(scene.objects[1].name, "Floor");
    assert_int_equal(scene.objects[1].type, OBJECT_PLANE);
    assert_int_equal(scene.objects[1].material, 1);
    assert_vector(scene.objects[1].plane.point, -1e15, 0, 1e15);
    assert_vector(scene.objects[1].plane.normal, 0, 1e-320, 0);
    assert_int_equal(scene.objects[1].place.line, 8);
    assert_int_equal(scene.objects[1].place.column, 5);

    assert_int_equal(scene.light_count, 2);
    assert_int_equal(scene.lights[0].type, LIGHT_QUAD);
    assert_vector(scene.lights[0].quad.corner, 1, 5, -2);
    assert_vector(scene.lights[0].quad.u, -2, 0, 0);
    assert_vector(scene.lights[0].quad.v, 0, 1, 2);
    assert_vector(scene.lights[0].color, 1, 2, 3);
    assert_true(scene.lights[0].power == 40);
    assert_int_equal(scene.lights[0].place.line, 18);
    assert_int_equal(scene.lights[1].type, LIGHT_POINT);
    assert_vector(scene.lights[1].point.position, 0, 5, 0);
    assert_vector(scene.lights[1].color, 0.5, 0.25, 0);
    assert_true(scene.lights[1].power == 1e15);
    scene_destroy(&scene);
}

static void test_byte_order_mark_line_ends_and_aliases(void **state)
{
    (void)state;
    struct scene scene;
    read_good("\xEF\xBB\xBF# a comment\r\ncamera: { position: &zero [0, 0, 0], look_at: [0, 0, 1] }\r\n"
              "image: { width: &n 4, height: *n }\r\nbackground: *zero\r\n",
              &scene);
    assert_int_equal(scene.height, 4);
    scene_destroy(&scene);

    read_good(HEAD
              "materials: [{ name: &m A, type: mirror }, { name: &m B, type: &n matte, color: [0, 0, 0] }]\n"
              "objects: [{ name: *n, type: sphere, center: [0, 0, 0], radius: 1, material: *m }]\n",
              &scene);
    assert_int_equal(scene.objects[0].material, 1);
    assert_string_equal(scene.objects[0].name, "matte");
    scene_destroy(&scene);

    assert_int_equal(read_text("\xEF\xBB\xBFwrong: 1\r\n", &scene), STATUS_REFUSED);
    assert_non_null(strstr(test_messages, "bad.yaml:1:1: error: unknown key"));
    assert_non_null(strstr(test_messages, "\nwrong: 1\n^\n"));

    read_text(HEAD "h\xC3\xBC: { x: 1 }\r\rmax_bounces:\t-1\r", &scene);
    assert_non_null(strstr(test_messages, "bad.yaml:5:14: error: max_bounces"));
    assert_non_null(strstr(test_messages, "\nmax_bounces:\t-1\n            \t^\n"));
}

static void test_long_names(void **state)
{
    (void)state;
    for (size_t length = 500; length < 520; ++length) {
        char text[1024] = HEAD "materials: [{ type: mirror, name: ";
        struct scene scene;
        size_t start = strlen(text);
        memset(text + start, 'n', length);
        strcpy(text + start + length, " }]\n");
        if (length < 512) {
            read_good(text, &scene);
            assert_int_equal(strlen(scene.materials[0].name), length);
            scene_destroy(&scene);
        } else {
            assert_int_equal(read_text(text, &scene), STATUS_REFUSED);
            assert_non_null(strstr(test_messages, "bad.yaml:3:35: error: mirror material \"nnn"));
            assert_non_null(strstr(test_messages, "nnn...\": name must be shorter than 512 bytes, is \"nnn"));
        }
    }
}

/* Not every "&" is an anchor, nor every bracket one that opens a list. */
static void test_signs_in_names(void **state)
{
    (void)state;
    char text[16384] = HEAD "materials:\n";
    struct scene scene;
    for (int i = 0; i < 150; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "  - { name: Q&A & B%d, type: mirror }\n  - { name: \"[ & %d\", type: mirror }\n", i, i);
    assert_true(strlen(text) + 1 < sizeof text);
    read_good(text, &scene);
    assert_int_equal(scene.material_count, 300);
    assert_string_equal(scene.materials[0].name, "Q&A & B0");
    assert_string_equal(scene.materials[299].name, "[ & 149");
    scene_destroy(&scene);
}

static void test_every_error_in_file_order(void **state)
{
    (void)state;
    struct scene scene;
    assert_int_equal(
        read_text("objects:\n  - { name: A, type: sphere, material: Z, radius: 0, center: [0, x, 0] }\n"
                  "materials:\n  - { name: B, type: mirror, ior: 2 }\n"
                  "image: { width: 0, height: 0 }\n",
                  &scene),
        STATUS_REFUSED);
    static const char *const places[] = {"1:1", "2:40", "2:51", "2:66", "4:30", "5:17", "5:28"};
    const char *at = test_messages;
    for (size_t i = 0; i < sizeof(places) / sizeof(places[0]); i++) {
        char head[64];
        snprintf(head, sizeof(head), "bad.yaml:%s: error: ", places[i]);
        at = strstr(at, head);
        if (!at)
            fail_msg("no error at %s, or out of order, in:\n%s", places[i], test_messages);
    }
    assert_int_equal(count_errors(), 7);
}

/* A billion laughs, a million errors, one endless line, a NUL byte: an answer, soon and short. */
static void test_hostile_texts(void **state)
{
    (void)state;
    struct scene scene;
    assert_int_equal(
        read_text("a: &a [x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a]\n"
                  "c: &c [*b, *b, *b, *b, *b, *b, *b, *b]\nd: &d [*c, *c, *c, *c, *c, *c, *c, *c]\n"
                  "objects: [*d, *d, *d, *d, *d, *d, *d, *d]\n",
                  &scene),
        STATUS_REFUSED);
    assert_int_equal(count_errors(), 14);

    const size_t size = 1 << 19;
    char *text = malloc(size + 1);
    assert_non_null(text);
    memset(text, '[', size);
    assert_int_equal(read_bytes(text, size, &scene), STATUS_REFUSED);
    assert_non_null(strstr(test_messages, "bad.yaml:1:300001: error: more than 300000 values; "));
    assert_true(strlen(test_messages) < 400);

    memset(text, ' ', size);
    memcpy(text, HEAD "objects: [", strlen(HEAD "objects: ["));
    for (size_t i = 200; i + 2 < size; i += 2)
        memcpy(text + i, "a,", 2);
    text[size - 1] = ']';
    assert_int_equal(read_bytes(text, size, &scene), STATUS_REFUSED);
    assert_int_equal(count_errors(), 101);
    assert_non_null(strstr(test_messages, " more errors\n"));

    for (size_t i = 200; i + 1 < size; i += 2)
        memcpy(text + i, ":\n", 2);
    assert_int_equal(read_bytes(text, size, &scene), STATUS_REFUSED);
    for (size_t i = 200; i + 2 < size; i += 2)
        memcpy(text + i, "-\n", 2);
    memcpy(text, HEAD "objects:\n", strlen(HEAD "objects:\n"));
    assert_int_equal(read_bytes(text, size, &scene), STATUS_REFUSED);

    for (size_t i = 0; i + 4 < size; i += 4)
        memcpy(text + i, "&a ,", 4);
    memcpy(text, HEAD "a: [", strlen(HEAD "a: ["));
    assert_int_equal(read_bytes(text, size, &scene), STATUS_REFUSED);
    assert_non_null(strstr(test_messages, " error: more than 100 anchors\n"));
    assert_int_equal(count_errors(), 1);
    free(text);

    static const char with_nul[] = HEAD "max_bounces: 5\0wrong: 1\n";
    assert_int_equal(read_bytes(with_nul, sizeof(with_nul) - 1, &scene), STATUS_REFUSED);
    assert_non_null(
        strstr(test_messages, "bad.yaml:3:15: error: must be printable UTF-8 text, has the byte 0x00"));
    assert_empty(&scene);
}

static void test_files_that_cannot_be_scenes(void **state)
{
    (void)state;
    struct scene scene;
    assert_int_equal(read_file(SOURCE_DIR "/scenes", &scene), STATUS_REFUSED);
    assert_string_equal(test_messages, SOURCE_DIR "/scenes: error: is a folder, not a file\n");
    assert_int_equal(read_file("/no/such.yaml", &scene), STATUS_REFUSED);
    assert_string_equal(test_messages, "/no/such.yaml: error: No such file or directory\n");
    assert_int_equal(read_file("/dev/zero", &scene), STATUS_REFUSED);
    assert_string_equal(test_messages, "/dev/zero: error: is larger than 16 MiB, not a scene file\n");
    assert_int_equal(read_file("/dev/null", &scene), STATUS_REFUSED);
    assert_non_null(strstr(test_messages, "/dev/null:1:1: error: the file is empty"));
    assert_empty(&scene);
}

static void test_figures(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum light_type light;
        enum material_type first_sphere, second_sphere, front;
    } figures[] = {
        {"figure_2a", LIGHT_POINT, MATERIAL_MATTE, MATERIAL_MATTE, MATERIAL_MATTE},
        {"figure_2b", LIGHT_QUAD, MATERIAL_MATTE, MATERIAL_MATTE, MATERIAL_MATTE},
        {"figure_3a", LIGHT_POINT, MATERIAL_MIRROR, MATERIAL_MATTE, MATERIAL_MATTE},
        {"figure_3b", LIGHT_POINT, MATERIAL_MIRROR, MATERIAL_MIRROR, MATERIAL_MATTE},
        {"figure_3c", LIGHT_POINT, MATERIAL_MIRROR, MATERIAL_MIRROR, MATERIAL_MIRROR},
        {"figure_4", LIGHT_POINT, MATERIAL_MIRROR, MATERIAL_TRANSPARENT, MATERIAL_MATTE},
    };
    for (size_t i = 0; i < sizeof(figures) / sizeof(figures[0]); i++) {
        char path[4096];
        struct scene scene;
        snprintf(path, sizeof(path), "%s/scenes/%s.yaml", SOURCE_DIR, figures[i].name);
        if (read_file(path, &scene) != STATUS_DONE)
            fail_msg("%s", test_messages);
        assert_string_equal(scene.path, path);
        assert_int_equal(scene.object_count, 7);
        assert_int_equal(scene.light_count, 1);
        assert_int_equal(scene.lights[0].type, figures[i].light);
        assert_int_equal(scene.materials[scene.objects[0].material].type, figures[i].first_sphere);
        assert_int_equal(scene.materials[scene.objects[1].material].type, figures[i].second_sphere);
        assert_int_equal(scene.materials[scene.objects[6].material].type, figures[i].front);
        for (size_t m = 0; m < scene.material_count; m++) {
            size_t users = 0;
            for (size_t o = 0; o < scene.object_count; o++)
                users += scene.objects[o].material == m;
            assert_true(users > 0);
            assert_true(scene.materials[m].roughness ==
                        (scene.materials[m].type == MATERIAL_MATTE ? 0.6 : 0));
        }
        scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_scenes),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_every_field),
        cmocka_unit_test(test_byte_order_mark_line_ends_and_aliases),
        cmocka_unit_test(test_long_names),
        cmocka_unit_test(test_signs_in_names),
        cmocka_unit_test(test_every_error_in_file_order),
        cmocka_unit_test(test_hostile_texts),
        cmocka_unit_test(test_files_that_cannot_be_scenes),
        cmocka_unit_test(test_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
