/* From a scene file to what finds its many spheres: each part shows a bar where it takes long, the first
 * Ctrl-C ends it at once, and the device's part is small. */
#include "cmocka_test.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/interrupt.h"
#include "npy_file.h"
#include "scene/warnings.h"
#include "test_folder.h"
#include "test_render.h"
#include "tracer/reference_scene.h"
#include "tracer/sphere_records.h"

enum { ROWS = 70000, DEVICE_BYTES = 80 /* a sphere */, MILLISECOND = 1000000 /* ns */ };

/* A processor timer is looked at in ticks of up to 10 ms, for which two threads are charged; and memory is
 * given back. All the building is more than twice as much. */
enum { LATE_MS = 40 };

/* With the linker's --wrap. As if each look at the clock came a second after the last one, where so. */
static bool slow;
double __real_clock_ms(void);
double __wrap_clock_ms(void);
double __wrap_clock_ms(void)
{
    static double seconds;
    return slow ? 1000 * ++seconds : __real_clock_ms();
}

/* Glass that does not touch, in a lattice. */
static void write_scene(void)
{
    static float rows[ROWS][4];
    for (int i = 0; i < ROWS; ++i) {
        rows[i][0] = (float)(i % 64);
        rows[i][1] = (float)(i / 64 % 64);
        rows[i][2] = (float)(i / 4096);
        rows[i][3] = 0.25F;
    }
    npy_write("rows.npy", ROWS, rows);
    FILE *file = fopen("a.yaml", "w");
    assert_non_null(file);
    fputs("camera: { position: [9, 9, -9], look_at: [9, 9, 0] }\n"
          "image: { width: 6, height: 4 }\n"
          "materials:\n"
          "  - { name: Glass, type: transparent }\n"
          "objects:\n"
          "  - { name: Glass, type: spheres, file: rows.npy, material: Glass }\n"
          "lights:\n"
          "  - { type: point, position: [5, 4, -5], power: 100 }\n",
          file);
    assert_int_equal(fclose(file), 0);
}

/* Whether the device's part is as small as it is to be, and has room for the boxes. */
static bool build_all(const char *path)
{
    struct scene scene;
    struct packed_scene packed, reference;
    assert_int_equal(scene_read(path, &scene), STATUS_DONE);
    const struct picture_settings settings = test_settings(&scene);
    packed = test_pack(&scene, settings);
    scene_warn(&scene, &packed);
    assert_int_equal(reference_scene(&packed, 2, &reference), STATUS_DONE);
    const uint64_t record_count = sphere_record_count(&packed), word_count = sphere_word_count(&packed);
    uint32_t(*records)[4] = calloc(record_count, sizeof *records);
    uint32_t *words = calloc(word_count, sizeof *words);
    assert_true(records && words);
    sphere_records_write(&packed, records, words);
    const bool fits = record_count * sizeof *records + word_count * sizeof *words <=
                          DEVICE_BYTES * (uint64_t)packed.sphere_count &&
                      records[STREAM][1] <= record_count;
    free(records);
    free(words);
    pack_destroy(&packed);
    scene_destroy(&scene);
    return fits;
}

/* What the child has used of processors. */
static double cpu_ms(const struct rusage *usage)
{
    return 1e3 * (double)(usage->ru_utime.tv_sec + usage->ru_stime.tv_sec) +
           1e-3 * (double)(usage->ru_utime.tv_usec + usage->ru_stime.tv_usec);
}

/* Wherever it comes: the signal is sent after so much work, and little more follows. */
static void interrupted(void **state)
{
    int interruptions = 0;
    (void)state;
    for (long after_ms = 5;; after_ms += 20) {
        struct rusage usage;
        int how;
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGINT};
            const struct itimerspec when = {
                .it_value = {.tv_sec = after_ms / 1000, .tv_nsec = after_ms % 1000 * MILLISECOND}};
            timer_t timer;
            interrupt_catch();
            if (timer_create(CLOCK_PROCESS_CPUTIME_ID, &event, &timer) != 0 ||
                timer_settime(timer, 0, &when, NULL) != 0)
                _exit(1);
            _exit(!build_all("a.yaml"));
        }
        assert_int_equal(wait4(child, &how, 0, &usage), child);
        if (WIFEXITED(how)) {
            assert_int_equal(WEXITSTATUS(how), 0);
            break;
        }
        assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGINT);
        if (cpu_ms(&usage) > (double)after_ms + LATE_MS)
            fail_msg("after %ld ms: ended after %.1f", after_ms, cpu_ms(&usage));
        ++interruptions;
    }
    assert_true(interruptions > 4);
}

static void bars(void **state)
{
    static const char *const labels[] = {"reading spheres",  "looking for overlaps",
                                         "hierarchy",        "looking into glass",
                                         "reference's tree", "boxes for the device"};
    static char text[1 << 18];
    (void)state;
    const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
    const int other_end = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    assert_true(other_end >= 0 && fcntl(terminal, F_SETFL, O_NONBLOCK) == 0);
    const pid_t child = fork(); /* writes what a terminal does not hold */
    if (child == 0) {
        dup2(other_end, STDERR_FILENO);
        slow = true;
        _exit(!build_all("a.yaml"));
    }
    int how = 0;
    size_t length = 0;
    for (bool ended = false; !ended;) {
        ended = waitpid(child, &how, WNOHANG) == child;
        for (ssize_t got; (got = read(terminal, text + length, sizeof text - 1 - length)) > 0;)
            length += (size_t)got;
        nanosleep(&(struct timespec){.tv_nsec = MILLISECOND}, NULL);
    }
    assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 0);
    for (size_t i = 0; i < sizeof labels / sizeof *labels; ++i) {
        char bar[64];
        snprintf(bar, sizeof bar, "\r%s [#", labels[i]);
        if (!strstr(text, bar))
            fail_msg("no bar of \"%s\"", labels[i]);
    }
    assert_string_equal(text + length - 4, "\r\033[K");
    close(other_end);
    close(terminal);
}

/* There is no room for all boxes of these that are worth it. */
static void device_memory(void **state)
{
    (void)state;
    assert_true(build_all(SOURCE_DIR "/scenes/hard/sphere_decades.yaml"));
}

static int setup(void **state)
{
    if (test_folder_setup(state) != 0)
        return -1;
    write_scene();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(interrupted), cmocka_unit_test(bars),
                                       cmocka_unit_test(device_memory)};
    return cmocka_run_group_tests_name("building", tests, setup, test_folder_teardown);
}
