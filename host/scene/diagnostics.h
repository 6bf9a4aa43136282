#ifndef VKWHITTED_SCENE_DIAGNOSTICS_H
#define VKWHITTED_SCENE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stddef.h>

#include "scene/scene.h"

/* The errors found in one scene file: gathered while it is read, then printed in the order of the file. */

enum {
    REPORT_MAX_ERRORS = 100, /* kept; further ones are only counted */
    REPORT_QUOTE_SIZE = 64,  /* bytes that report_quote() writes at most, the terminator included */
};

struct diagnostics {
    const char *path;
    const char *text; /* the whole file, for showing lines; not owned */
    size_t length;
    size_t count; /* all errors met, kept or not */
    struct scene_error {
        struct scene_place place;
        char *message;
    } errors[REPORT_MAX_ERRORS];
    bool no_memory; /* an allocation failed anywhere in the reading */
    bool unable;    /* an error is the machine's, not the file's */
};

__attribute__((format(printf, 3, 4))) void report_error(struct diagnostics *report, struct scene_place place,
                                                        const char *format, ...);

/* Prints each error to standard error as "path:line:column: error: message", the line and a caret, and frees
 * the messages. */
void report_print(struct diagnostics *report);

/* Frees the messages without a word. */
void report_discard(struct diagnostics *report);

/* Writes text between double quotes, shortened where long; returns out. */
const char *report_quote(const char *text, size_t length, char out[REPORT_QUOTE_SIZE]);

#endif
