/* `vkwhitted watch` in a window on an X server of the test's own, as a user sees it; validated throughout. */
#include "cmocka_test.h"

#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#include "base/clock.h"
#include "image/transfer.h"
#include "x11_window.h"
#include "xvfb.h"

enum { WIDTH = 120, HEIGHT = 80, PIXELS = WIDTH * HEIGHT };
static const double patience_ms = 60000; /* more than a loaded machine takes */

static char folder[] = "/tmp/vkwhitted-test-XXXXXX";
static pid_t server, program;
static struct x11_window window;

static bool run(const char *command)
{
    return system(command) == 0;
}

/* Waits until it is true. */
#define EVENTUALLY(condition)                                                                                \
    for (double start_ = clock_ms(); !(condition);) {                                                        \
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);                                            \
        if (clock_ms() > start_ + patience_ms) {                                                             \
            run("cat err >&2");                                                                              \
            fail_msg("never: %s", #condition);                                                               \
        }                                                                                                    \
    }

static bool finds_window(void)
{
    if (x11_window_find(&window))
        return true;
    if (window.server)
        XCloseDisplay(window.server);
    return false;
}

static bool has_title_with(const char *part)
{
    char *name = NULL;
    bool has = XFetchName(window.server, window.id, &name) && strstr(name, part) != NULL;
    if (name)
        XFree(name);
    return has;
}

/* What a window of the picture's size should show, as RGB; from the picture of the scene as it is now. */
static void render_expected(uint8_t rgb[3 * PIXELS])
{
    static struct transfer_encoder encoder;
    static float linear[3 * PIXELS];
    assert_true(run(VKWHITTED " render -q s.yaml -o expected.pfm"));
    FILE *file = fopen("expected.pfm", "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, -(long)sizeof linear, SEEK_END), 0);
    assert_int_equal(fread(linear, sizeof *linear, 3 * PIXELS, file), 3 * PIXELS);
    fclose(file);
    transfer_encoder_init(TRANSFER_SRGB, &encoder);
    for (int y = 0; y < HEIGHT; ++y) /* a PFM begins at the bottom */
        transfer_encode(&encoder, linear + 3 * WIDTH * (HEIGHT - 1 - y), 3 * WIDTH, rgb + 3 * WIDTH * y);
}

/* NULL: black. */
static bool shows(const uint8_t *rgb)
{
    XImage *image = x11_window_pixels(&window);
    bool same = image && image->width == WIDTH && image->height == HEIGHT;
    for (int i = 0; i < PIXELS && same; ++i)
        for (int c = 0; c < 3 && same; ++c)
            same = (uint8_t)image->data[4 * i + 2 - c] == (rgb ? rgb[3 * i + c] : 0);
    if (image)
        XDestroyImage(image);
    return same;
}

static void starts_with_the_picture(void **state)
{
    static uint8_t expected[3 * PIXELS];
    (void)state;
    EVENTUALLY(finds_window());
    render_expected(expected);
    EVENTUALLY(shows(expected));
    EVENTUALLY(has_title_with("s.yaml - "));
    EVENTUALLY(has_title_with(" ms"));
}

static void follows_the_files(void **state)
{
    static uint8_t expected[3 * PIXELS];
    (void)state;
    assert_true(run("sed -i 's/power: 100/power: 50/' s.yaml"));
    render_expected(expected);
    EVENTUALLY(shows(expected));
    assert_true(run("sed -i '5s/$/ wrong/' shaders/shade.glsl"));
    EVENTUALLY(has_title_with("compile failed: shaders/shade.glsl:5: error: "));
    assert_true(shows(expected));
    assert_true(run("cp " SOURCE_DIR "/shaders/shade.glsl shaders/"));
    EVENTUALLY(!has_title_with("compile failed"));
    assert_true(run("sed -i 's/radius: /radius: -/' s.yaml"));
    EVENTUALLY(has_title_with("scene refused"));
    assert_true(shows(expected));
    assert_true(run("sed -i 's/radius: -/radius: /' s.yaml"));
    EVENTUALLY(!has_title_with("scene refused"));
}

static void drag(int x, int y, unsigned modifiers)
{
    x11_window_move_pointer(&window, 50, 40);
    x11_window_button(&window, 1, true, modifiers);
    for (int i = 1; i <= 4; ++i)
        x11_window_move_pointer(&window, 50 + x * i / 4, 40 + y * i / 4);
    x11_window_button(&window, 1, false, modifiers);
}

/* The camera of P, put into the scene file, gives the picture on show; R goes back. */
static void moves_the_camera(void **state)
{
    static uint8_t before[3 * PIXELS], expected[3 * PIXELS];
    (void)state;
    render_expected(before);
    EVENTUALLY(shows(before));
    drag(30, -8, 0);
    EVENTUALLY(!shows(before));
    x11_window_button(&window, 4, true, 0);
    x11_window_key(&window, XK_p, 0);
    EVENTUALLY(run("grep -q '^camera: ' out"));
    assert_true(run("cp s.yaml kept.yaml && (grep '^camera: ' out | tail -n 1; grep -v '^camera:' kept.yaml) "
                    ">moved.yaml"));
    assert_true(run("cp moved.yaml s.yaml"));
    render_expected(expected); /* while the camera is where it was dragged to, and afterwards */
    EVENTUALLY(shows(expected));
    x11_window_button(&window, 5, true, 0);
    EVENTUALLY(!shows(expected));
    x11_window_key(&window, XK_r, 0);
    EVENTUALLY(shows(expected));
    assert_true(run("cp kept.yaml s.yaml"));
    EVENTUALLY(shows(before));
}

static void saves_and_compares(void **state)
{
    static uint8_t expected[3 * PIXELS];
    (void)state;
    render_expected(expected);
    EVENTUALLY(shows(expected));
    x11_window_key(&window, XK_s, 0);
    EVENTUALLY(run("test -e s-1.png"));
    assert_true(run(VKWHITTED " render -q s.yaml -o expected.png && cmp s-1.png expected.png"));
    x11_window_key(&window, XK_s, 0);
    EVENTUALLY(run("test -e s-2.png"));
    x11_window_key(&window, XK_d, 0);
    EVENTUALLY(shows(NULL));
    EVENTUALLY(has_title_with("0 pixels differ from the reference"));
    x11_window_key(&window, XK_d, 0);
    EVENTUALLY(shows(expected));
}

static void ends_with_escape(void **state)
{
    int status;
    (void)state;
    x11_window_key(&window, XK_Escape, 0);
    assert_int_equal(waitpid(program, &status, 0), program);
    program = 0;
    if (!WIFEXITED(status))
        fail_msg("ended by signal %d", WTERMSIG(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    assert_false(run("grep -q alidation err"));
}

static int setup(void **state)
{
    static char *const arguments[] = {"vkwhitted", "watch",      "s.yaml", "--shaders",
                                      "shaders",   "--validate", NULL};
    extern char **environ;
    posix_spawn_file_actions_t files;
    (void)state;
    if (!mkdtemp(folder) || chdir(folder) != 0 || (server = xvfb_start()) < 0 ||
        !run("cp -r " SOURCE_DIR "/shaders . && "
             "sed 's/width: 600, height: 400/width: 120, height: 80/' " SOURCE_DIR
             "/scenes/figure_4.yaml >s.yaml"))
        return -1;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "out", O_WRONLY | O_CREAT, 0666);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "err", O_WRONLY | O_CREAT, 0666);
    int error = posix_spawn(&program, VKWHITTED, &files, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

static int teardown(void **state)
{
    char command[64];
    (void)state;
    if (program > 0) {
        kill(program, SIGKILL);
        waitpid(program, NULL, 0);
    }
    if (window.server)
        XCloseDisplay(window.server);
    xvfb_kill(server);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return chdir("/") == 0 && run(command) ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_with_the_picture), cmocka_unit_test(follows_the_files),
        cmocka_unit_test(moves_the_camera),        cmocka_unit_test(saves_and_compares),
        cmocka_unit_test(ends_with_escape),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
