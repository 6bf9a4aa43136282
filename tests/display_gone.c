#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "display.h"
#include "progress.h"
#include "test_folder.h"
#include "x11_window.h"
#include "xvfb.h"

/* Displays that go away. Each time a process of its own starts an X server, opens a window, has the server
 * killed at some moment, and must end by itself with one message, validation being on. */

enum { WIDTH = 320, HEIGHT = 200, WRONG = 99 };

static unsigned char rgba[WIDTH * HEIGHT * 4];

/* What a child expects; it has no cmocka to tell. */
#define CHECK(condition)                                                                                     \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            fprintf(stderr, "line %d: %s\n", __LINE__, #condition);                                          \
            _exit(WRONG);                                                                                    \
        }                                                                                                    \
    } while (0)

struct child {
    pid_t server;
    struct vulkan_context *context;
    struct display *display;
};

static void pause_ms(double milliseconds)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)(milliseconds * 1e6)}, NULL);
}

struct killing {
    pid_t server;
    double delay_ms;
    pthread_t thread;
};

static void *kill_later(void *user)
{
    const struct killing *killing = user;
    pause_ms(killing->delay_ms);
    kill(killing->server, SIGKILL);
    display_wake();
    return NULL;
}

static void start_killing(struct child *child, struct killing *killing, double delay_ms)
{
    killing->server = child->server;
    killing->delay_ms = delay_ms;
    CHECK(pthread_create(&killing->thread, NULL, kill_later, killing) == 0);
}

static void open_context(struct child *child)
{
    child->server = xvfb_start();
    CHECK(child->server > 0);
    CHECK(vulkan_context_create(&(struct vulkan_options){.validate = true, .presents = true},
                                &child->context) == STATUS_DONE);
}

static void open_window(struct child *child)
{
    open_context(child);
    CHECK(display_create(child->context, WIDTH, HEIGHT, &child->display) == STATUS_DONE);
}

static void kill_before_window(struct child *child, double unused)
{
    (void)unused;
    open_context(child);
    xvfb_kill(child->server);
    CHECK(display_create(child->context, WIDTH, HEIGHT, &child->display) == STATUS_UNABLE);
    CHECK(!child->display);
}

static void kill_before_first_picture(struct child *child, double unused)
{
    (void)unused;
    open_window(child);
    xvfb_kill(child->server);
    raise(SIGPIPE); /* as a write does that comes at the wrong moment */
    CHECK(display_show(child->display, rgba, WIDTH, HEIGHT) == STATUS_UNABLE);
}

static void kill_before_title(struct child *child, double unused)
{
    struct display_input input;
    (void)unused;
    open_window(child);
    CHECK(display_show(child->display, rgba, WIDTH, HEIGHT) == STATUS_DONE);
    xvfb_kill(child->server);
    for (int i = 0; i < 100; ++i)
        display_set_title(child->display, "nobody sees this");
    CHECK(display_wait(child->display, 10, &input) == STATUS_UNABLE);
}

static void kill_in_wait(struct child *child, double delay_ms)
{
    struct killing killing;
    struct display_input input;
    open_window(child);
    CHECK(display_show(child->display, rgba, WIDTH, HEIGHT) == STATUS_DONE);
    start_killing(child, &killing, delay_ms);
    enum status status;
    do
        status = display_wait(child->display, 1e6, &input);
    while (status == STATUS_DONE);
    CHECK(status == STATUS_UNABLE);
    CHECK(display_wait(child->display, 1e6, &input) == STATUS_UNABLE);
    pthread_join(killing.thread, NULL);
}

/* While pictures are shown, titles set and the window resized, as fast as it goes. */
static void kill_at_work(struct child *child, double delay_ms)
{
    struct killing killing;
    struct x11_window window;
    struct display_input input;
    open_window(child);
    CHECK(x11_window_find(&window));
    for (unsigned i = 0; i < 1000; ++i)
        XResizeWindow(window.server, window.id, 300 + i % 100, 200);
    XCloseDisplay(window.server);
    start_killing(child, &killing, delay_ms);
    enum status status = STATUS_DONE;
    for (unsigned i = 0; status == STATUS_DONE; ++i) {
        char title[16];
        snprintf(title, sizeof title, "%u", i);
        display_set_title(child->display, title);
        status = i % 2 ? display_wait(child->display, 1e-3, &input)
                       : display_show(child->display, rgba, WIDTH, HEIGHT);
    }
    CHECK(status == STATUS_UNABLE);
    pthread_join(killing.thread, NULL);
}

/* Runs it in a child and expects one message and an ordinary exit. */
static void assert_ends(void (*run)(struct child *, double), double delay_ms)
{
    char line[256];
    int result = 0;
    fflush(NULL);
    test_messages_begin();
    pid_t process = fork();
    if (process == 0) {
        struct child child = {0};
        alarm(60);
        run(&child, delay_ms);
        display_destroy(&child.display);
        CHECK(vulkan_context_destroy(&child.context) == STATUS_DONE);
        exit(STATUS_UNABLE);
    }
    waitpid(process, &result, 0);
    int lines = test_messages_end(line);
    print_message("after %g ms: %s\n", delay_ms, line);
    if (WIFSIGNALED(result))
        fail_msg("ended by signal %d", WTERMSIG(result));
    assert_int_equal(WEXITSTATUS(result), STATUS_UNABLE);
    assert_string_equal(line, "vkwhitted: error: the display has gone away");
    assert_int_equal(lines, 1);
}

static void test_before_window(void **state)
{
    (void)state;
    assert_ends(kill_before_window, 0);
}

static void test_before_first_picture(void **state)
{
    (void)state;
    assert_ends(kill_before_first_picture, 0);
}

static void test_before_title(void **state)
{
    (void)state;
    assert_ends(kill_before_title, 0);
}

static void test_in_wait(void **state)
{
    (void)state;
    assert_ends(kill_in_wait, 0);
    assert_ends(kill_in_wait, 200);
}

static void test_at_work(void **state)
{
    (void)state;
    for (double delay_ms = 0; delay_ms < 20; delay_ms += 5)
        assert_ends(kill_at_work, delay_ms);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_before_window), cmocka_unit_test(test_before_first_picture),
        cmocka_unit_test(test_before_title),  cmocka_unit_test(test_in_wait),
        cmocka_unit_test(test_at_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
