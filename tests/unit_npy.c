/* Spheres from a NumPy file: what is read of each kind of array, and what is said of other files. */
#include "cmocka_test.h"

#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

#include "npy_file.h"
#include "scene_capture.h"
#include "test_folder.h"

#define HEAD                                                                                                 \
    "camera: { position: [0, 0, 0], look_at: [0, 0, 1] }\nimage: { width: 4, height: 4 }\n"                  \
    "materials: [{ name: M, type: mirror }]\nobjects:\n"
#define FLAKE HEAD "  - { name: Flake, type: spheres, file: flake.npy, material: M }\n"
#define PLACE "bad.yaml:5:41: error: spheres \"Flake\": flake.npy: "

enum { ROWS = 5 };

/* Exact in float. */
static double value_of(size_t row, size_t column)
{
    return column == 3 ? 0.25 + (double)row : (double)row * 1.5 - (double)column;
}

static void put(FILE *file, double value, int size, bool big_endian)
{
    unsigned char bytes[8];
    const float single = (float)value;
    memcpy(bytes, size == 4 ? (const void *)&single : (const void *)&value, (size_t)size);
    for (int i = 0; i < size; ++i)
        putc(bytes[big_endian ? size - 1 - i : i], file);
}

static void write_array(const char *dictionary, int size, bool big_endian, bool columns_first)
{
    FILE *file = fopen("flake.npy", "wb");
    assert_non_null(file);
    npy_write_header(file, dictionary);
    for (size_t i = 0; i < 4 * ROWS; ++i)
        put(file, columns_first ? value_of(i % ROWS, i / ROWS) : value_of(i / 4, i % 4), size, big_endian);
    assert_int_equal(fclose(file), 0);
}

static void check_rows(const char *what)
{
    struct scene scene;
    if (read_text(FLAKE, &scene) != STATUS_DONE)
        fail_msg("%s is refused: %s", what, test_messages);
    assert_int_equal(scene.objects[0].type, OBJECT_SPHERES);
    assert_int_equal(scene.objects[0].spheres.count, ROWS);
    for (size_t i = 0; i < 4 * ROWS; ++i)
        if ((double)scene.objects[0].spheres.rows[i / 4][i % 4] != value_of(i / 4, i % 4))
            fail_msg("%s: row %zu, column %zu", what, i / 4, i % 4);
    scene_destroy(&scene);
}

static void kinds_of_arrays(void **state)
{
    (void)state;
    for (int kind = 0; kind < 8; ++kind) {
        char dictionary[256];
        const int size = kind & 1 ? 8 : 4;
        const bool big_endian = kind & 2, columns_first = kind & 4;
        snprintf(dictionary, sizeof dictionary, "{'descr': '%cf%d', 'fortran_order': %s, 'shape': (5, 4), }",
                 big_endian ? '>' : '<', size, columns_first ? "True" : "False");
        write_array(dictionary, size, big_endian, columns_first);
        check_rows(dictionary);
    }
}

static void ways_of_writing_a_header(void **state)
{
    static const char *const dictionaries[] = {
        "{'descr':'<f4','fortran_order':False,'shape':(5,4)}",
        " { 'descr' : '<f4' , 'fortran_order' : False , 'shape' : ( 5 , 4 , ) , } ",
    };
    (void)state;
    for (size_t i = 0; i < sizeof dictionaries / sizeof *dictionaries; ++i) {
        write_array(dictionaries[i], 4, false, false);
        check_rows(dictionaries[i]);
    }
}

/* Of an array without rows nothing is left but the object. */
static void no_rows(void **state)
{
    float none[1][4] = {{0}};
    struct scene scene;
    (void)state;
    npy_write("flake.npy", 0, none);
    read_good(FLAKE, &scene);
    assert_int_equal(scene.object_count, 1);
    assert_int_equal(scene.objects[0].spheres.count, 0);
    scene_destroy(&scene);
}

static void check_refused(const char *message)
{
    struct scene scene;
    char expected[512];
    snprintf(expected, sizeof expected, PLACE "%s\n", message);
    enum status status = read_text(FLAKE, &scene);
    if (status != STATUS_REFUSED || strncmp(test_messages, expected, strlen(expected)) != 0)
        fail_msg("status %d, expected:\n%sfound:\n%s", (int)status, expected, test_messages);
    assert_non_null(strstr(test_messages, "^\n"));
    assert_true(!scene.objects && !scene.path);
}

#define DTYPE "its dtype must be float32 or float64, is "
#define SHAPE "its shape must be (N, 4): x, y, z, radius, is "
#define WRONG "its NumPy header must be a dictionary of 'descr', 'fortran_order' and 'shape', in this order"

/* Headers before the bytes of five rows of float32. */
static void wrong_headers(void **state)
{
    static const struct {
        const char *dictionary, *message;
    } wrong[] = {
        {"{'descr': '<i4', 'fortran_order': False, 'shape': (5, 4), }", DTYPE "'<i4'"},
        {"{'descr': '<f2', 'fortran_order': False, 'shape': (5, 4), }", DTYPE "'<f2'"},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (5, 4), }", DTYPE "'|u1'"},
        {"{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (5,), }",
         DTYPE "[('x', '<f4'), ('y', '<f4')]"},
        {"{'descr': '|O', 'fortran_order': False, 'shape': (5, 4), }",
         "holds pickled Python objects, which are not read"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (5, 3), }", SHAPE "(5, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (4, 5), }", SHAPE "(4, 5)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (20,), }", SHAPE "(20,)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (), }", SHAPE "()"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (5, 2, 2), }", SHAPE "(5, 2, 2)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 4), }",
         SHAPE "(99999999999999999999, 4)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (16000001, 4), }",
         "has 16000001 rows; a scene may have 16000000 spheres in all"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (-5, 4), }", SHAPE "(-5, 4)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': 5, }", WRONG},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (5, 40), }", SHAPE "(5, 40)"},
        {"{'descr': '<f4', 'fortran_order': 0, 'shape': (5, 4), }", WRONG},
        {"{'descr': <f4, 'fortran_order': False, 'shape': (5, 4), }", WRONG},
        {"{'descr': '<f4', 'fortran_order': False, }", WRONG},
        {"{'fortran_order': False, 'shape': (5, 4), 'descr': '<f4', }", WRONG},
        {"{'descr': '<f4', 'order': False, 'shape': (5, 4), }", WRONG},
        {"{'descr': '<f4' 'fortran_order': False, 'shape': (5, 4), }", WRONG},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (5, 4), } x", SHAPE "(5, 4)"},
        {"[1, 2]", WRONG},
        {"", WRONG},
        {"{'descr", WRONG},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (4, 4), }",
         "is longer than its header says: 16 bytes behind row 3 of 4"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 4), }",
         "is longer than its header says: 80 bytes behind row 0 of 0"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (6, 4), }",
         "is truncated: its header says 6 rows, it ends in row 5"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (5, 4), }",
         "is truncated: its header says 5 rows, it ends in row 2"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        write_array(wrong[i].dictionary, 4, false, false);
        check_refused(wrong[i].message);
    }
}

static void other_files(void **state)
{
    (void)state;
    check_refused("No such file or directory");
    test_write_file("flake.npy", "", 0);
    check_refused("is not a NumPy file (.npy)");
    test_write_file("flake.npy", "\x93NUMPY\1\0", 8);
    check_refused("is not a NumPy file (.npy)");
    test_write_file("flake.npy", "PK\3\4 the archive that numpy.savez() writes", 40);
    check_refused("is not a NumPy file (.npy)");
    test_write_file("flake.npy", "\x93NUMPY\2\0\x10\0                ", 26);
    check_refused("has version 2.0 of NumPy's format; 1.0 is known");
    test_write_file("flake.npy", "\x93NUMPY\1\0\x76\0{'descr'", 18);
    check_refused("is truncated: it ends in its header");
    test_write_file("flake.npy", "\x93NUMPY\1\0\0\xFF{}", 12);
    check_refused("has a header of 65290 bytes, more than 4096");
    assert_int_equal(unlink("flake.npy") | mkdir("flake.npy", 0777), 0);
    check_refused("is a folder, not a file");
    assert_int_equal(rmdir("flake.npy") | mkfifo("flake.npy", 0666), 0);
    check_refused("is not a regular file");
    assert_int_equal(unlink("flake.npy"), 0);
}

static void wrong_values(void **state)
{
    static const struct {
        size_t row, column;
        double value;
        const char *message;
    } wrong[] = {
        {17, 3, -1, "row 17: radius must be > 0, is -1"},
        {0, 3, 0, "row 0: radius must be > 0, is 0"},
        {99, 3, 1e-16, "row 99: radius must be within 1e-15..1e15, is 1e-16"},
        {99, 3, 1.1e15, "row 99: radius must be within 1e-15..1e15, is 1.1e+15"},
        {3, 0, 2e15, "row 3: x must be within -1e15..1e15, is 2e+15"},
        {4, 1, -2e15, "row 4: y must be within -1e15..1e15, is -2e+15"},
        {5, 2, 1e300, "row 5: z must be within -1e15..1e15, is 1e+300"},
        {6, 0, (double)NAN, "row 6: x must be a finite number, is nan"},
        {7, 1, (double)INFINITY, "row 7: y must be a finite number, is inf"},
        {8, 3, (double)-INFINITY, "row 8: radius must be a finite number, is -inf"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
        for (int columns_first = 0; columns_first < 2; ++columns_first) {
            FILE *file = fopen("flake.npy", "wb");
            assert_non_null(file);
            npy_write_header(file, columns_first
                                       ? "{'descr': '<f8', 'fortran_order': True, 'shape': (100, 4), }"
                                       : "{'descr': '<f8', 'fortran_order': False, 'shape': (100, 4), }");
            for (size_t at = 0; at < 400; ++at) {
                const size_t row = columns_first ? at % 100 : at / 4,
                             column = columns_first ? at / 100 : at % 4;
                put(file, row == wrong[i].row && column == wrong[i].column ? wrong[i].value : 1, 8, false);
            }
            assert_int_equal(fclose(file), 0);
            check_refused(wrong[i].message);
        }
}

/* A file lies where the scene file does, unless its path is absolute. */
static void paths(void **state)
{
    float row[1][4] = {{1, 2, 3, 4}};
    char text[1024], expected[1024];
    struct scene scene;
    (void)state;
    assert_int_equal(mkdir("sub", 0777), 0);
    npy_write("sub/flake.npy", 1, row);
    assert_int_equal(scene_read_text("sub/a.yaml", FLAKE, strlen(FLAKE), &scene), STATUS_DONE);
    assert_int_equal(scene.objects[0].spheres.count, 1);
    scene_destroy(&scene);
    snprintf(text, sizeof text, HEAD "  - { name: A, type: spheres, file: %s/sub/flake.npy, material: M }\n",
             test_folder);
    read_good(text, &scene);
    scene_destroy(&scene);

    char *files = scene_list_files("sub/a.yaml", FLAKE, strlen(FLAKE));
    assert_memory_equal(files, "sub/flake.npy\0", sizeof "sub/flake.npy\0");
    free(files);
    snprintf(text, sizeof text,
             "objects: [{ file: a b }, 5, { file: &f '%s/x' }, { file: *f }, { file: [] }]\n", test_folder);
    files = scene_list_files("a.yaml", text, strlen(text)); /* wrong as it is */
    size_t length =
        (size_t)snprintf(expected, sizeof expected, "a b%c%s/x%c%s/x%c", 0, test_folder, 0, test_folder, 0);
    assert_memory_equal(files, expected, length + 1);
    free(files);
    assert_null(scene_list_files("a.yaml", "]", 1));
    assert_null(scene_list_files("a.yaml", HEAD, strlen(HEAD)));
    assert_int_equal(unlink("sub/flake.npy") | rmdir("sub"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_files),
        cmocka_unit_test(kinds_of_arrays),
        cmocka_unit_test(ways_of_writing_a_header),
        cmocka_unit_test(no_rows),
        cmocka_unit_test(wrong_headers),
        cmocka_unit_test(wrong_values),
        cmocka_unit_test(paths),
    };
    return cmocka_run_group_tests(tests, test_folder_setup, test_folder_teardown);
}
