#ifndef VKWHITTED_CHECK_JUNIT_H
#define VKWHITTED_CHECK_JUNIT_H

#include <stdio.h>

#include "base/status.h"

/* A report in the XML of JUnit, as GitLab, Jenkins and GitHub's actions read it, while it grows. */
struct junit {
    FILE *cases; /* in memory; NULL: there was no memory */
    char *text;
    size_t size;
    unsigned tests, failures, errors;
};

void junit_create(struct junit *junit);

/* Adds the test case of a scene that took so many seconds: passed with STATUS_DONE, failed with
 * STATUS_DIFFERS for the reason told, otherwise an error. */
void junit_add(struct junit *junit, const char *scene, double seconds, enum status outcome,
               const char *reason);

/* Writes the report to the file, or where that is NULL nowhere, and destroys it. Names are escaped as they
 * are on a terminal. STATUS_UNABLE (reported). */
enum status junit_write(struct junit *junit, const char *path);

#endif
