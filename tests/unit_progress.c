/* A message takes the progress bar's place; what takes minutes says so. */
#include "cmocka_test.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/progress.h"
#include "base/status.h"

/* Reads what came to the terminal until it is quiet. */
static void read_terminal(int terminal, char *text, size_t size)
{
    struct pollfd wanted = {.fd = terminal, .events = POLLIN};
    size_t length = 0;
    while (length + 1 < size && poll(&wanted, 1, 100) > 0) {
        ssize_t got = read(terminal, text + length, size - length - 1);
        assert_true(got > 0);
        length += (size_t)got;
    }
    text[length] = '\0';
}

static void test_message_wipes_the_bar(void **state)
{
    (void)state;
    int terminal = posix_openpt(O_RDWR | O_NOCTTY), standard_error = dup(STDERR_FILENO);
    assert_true(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
    int other_end = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    assert_true(other_end >= 0);
    char bar[512], message[512], end[512];
    struct progress progress;

    dup2(other_end, STDERR_FILENO);
    progress_start(&progress, "testing", 10, false);
    progress.start_ms -= 1000;
    progress_advance(&progress, 5);
    read_terminal(terminal, bar, sizeof bar);
    log_warning("wait");
    read_terminal(terminal, message, sizeof message);
    progress_advance(&progress, 1);
    read_terminal(terminal, end, sizeof end);
    progress_end(&progress);
    read_terminal(terminal, end + strlen(end), sizeof end - strlen(end));
    dup2(standard_error, STDERR_FILENO);

    assert_non_null(strstr(bar, "testing [####"));
    assert_string_equal(message, "\r\033[Kvkwhitted: warning: wait\r\n");
    assert_non_null(strstr(end, "testing [####"));
    assert_string_equal(end + strlen(end) - 4, "\r\033[K");
    close(standard_error);
    close(other_end);
    close(terminal);
}

/* What the progress says on standard error, which is no terminal, so many seconds after its first advance,
 * before which it took long. */
static void say(uint64_t begun, uint64_t done, double seconds, bool quiet, char text[256])
{
    int ends[2], standard_error = dup(STDERR_FILENO);
    assert_int_equal(pipe(ends), 0);
    dup2(ends[1], STDERR_FILENO);
    struct progress progress;
    progress_start(&progress, "testing", 1000, quiet);
    progress.start_ms -= 5000;
    progress_begin(&progress, begun);
    progress_advance(&progress, 1);
    progress.first_ms -= seconds * 1000;
    progress_advance(&progress, done);
    progress_advance(&progress, 0);
    progress_end(&progress);
    dup2(standard_error, STDERR_FILENO);
    close(ends[1]);
    ssize_t length = read(ends[0], text, 255);
    assert_true(length >= 0);
    text[length] = '\0';
    close(ends[0]);
    close(standard_error);
}

static void test_minutes_are_announced_once(void **state)
{
    (void)state;
    const struct {
        uint64_t begun, done;
        double seconds;
        bool quiet;
        const char *expected;
    } cases[] = {
        {0, 1, 1.2, false, "vkwhitted: testing takes about 20 minutes\n"},
        {0, 1, 0.9, false, ""}, /* too early to say */
        {0, 100, 5.9, false, ""},
        {0, 100, 6.1, false, "vkwhitted: testing takes about 61 s\n"},
        {0, 1, 20, false, "vkwhitted: testing takes about 6 hours\n"},
        {0, 1, 1.2, true, ""},
        {0, 0, 5, false, ""},
        {10, 0, 1.2, false,
         "vkwhitted: testing takes more than 2 minutes\n"}, /* nothing done, little begun */
        {100, 0, 1.2, false, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        say(cases[i].begun, cases[i].done, cases[i].seconds, cases[i].quiet, text);
        assert_string_equal(text, cases[i].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_message_wipes_the_bar),
        cmocka_unit_test(test_minutes_are_announced_once),
    };
    return cmocka_run_group_tests_name("progress", tests, NULL, NULL);
}
