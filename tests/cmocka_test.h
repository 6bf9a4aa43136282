#ifndef VKWHITTED_CMOCKA_TEST_H
#define VKWHITTED_CMOCKA_TEST_H

/* cmocka, and before it what its header needs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#endif
