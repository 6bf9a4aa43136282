#include "cmocka_test.h"

#include <string.h>

#include "watch/display.h"

static void test_places(void **state)
{
    (void)state;
    static const struct {
        struct extent picture, window;
        struct area fit;
    } cases[] = {
        {{320, 200}, {320, 200}, {0, 0, 320, 200}},
        {{320, 200}, {500, 200}, {90, 0, 320, 200}},
        {{320, 200}, {320, 301}, {0, 50, 320, 200}},
        {{320, 200}, {3000, 2000}, {0, 62, 3000, 1875}},
        {{320, 200}, {160, 1000}, {0, 450, 160, 100}},
        {{320, 200}, {1, 1}, {0, 0, 1, 1}},
        {{320, 200}, {1, 1000}, {0, 499, 1, 1}},
        {{320, 200}, {1000, 1}, {499, 0, 2, 1}},
        {{65536, 1}, {100, 100}, {0, 49, 100, 1}},
        {{1, 65536}, {65536, 65536}, {32767, 0, 1, 65536}},
        {{65536, 65536}, {65535, 65536}, {0, 0, 65535, 65535}},
        {{320, 200}, {0, 100}, {0, 0, 0, 0}},
        {{320, 200}, {100, 0}, {0, 0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct area fit = fit_picture(cases[i].picture, cases[i].window);
        if (memcmp(&fit, &cases[i].fit, sizeof fit) != 0)
            fail_msg("case %zu: at %u, %u, %u x %u", i, fit.x, fit.y, fit.width, fit.height);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_places)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
