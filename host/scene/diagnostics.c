#include "scene/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/escape.h"
#include "base/status.h"

enum { SHOWN_AROUND = 100 }; /* bytes of a long line on either side of the caret */

static bool is_continuation(char byte)
{
    return ((unsigned char)byte & 0xC0) == 0x80;
}

static bool precedes(struct scene_place a, struct scene_place b)
{
    return a.line < b.line || (a.line == b.line && a.column < b.column);
}

void report_error(struct diagnostics *report, struct scene_place place, const char *format, ...)
{
    if (report->count++ >= REPORT_MAX_ERRORS)
        return;
    char *message = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&message, format, arguments) < 0) {
        report->no_memory = true;
        message = NULL;
    }
    va_end(arguments);
    size_t at = report->count - 1;
    for (; at > 0 && precedes(place, report->errors[at - 1].place); at--)
        report->errors[at] = report->errors[at - 1];
    report->errors[at] = (struct scene_error){place, message};
}

static bool is_line_end(const char *at, const char *end)
{
    return at == end || *at == '\n' || *at == '\r';
}

static const char *next_character(const char *at, const char *end)
{
    do
        at++;
    while (at < end && is_continuation(*at));
    return at;
}

/* As escape_character(), but for a tab, which stays. */
static size_t show(const char *text, size_t length, char shown[ESCAPED_SIZE])
{
    const size_t taken = escape_character(text, length, shown);
    if (*text == '\t')
        strcpy(shown, "\t");
    return taken;
}

static void print_line_and_caret(const struct diagnostics *report, struct scene_place place)
{
    const char *start = report->text, *end = start + report->length, *caret, *stop;
    for (int line = 1; line < place.line && start < end; start++)
        line += *start == '\n' || (*start == '\r' && (start + 1 == end || start[1] != '\n'));
    caret = start;
    for (int column = 1; column < place.column && !is_line_end(caret, end); column++)
        caret = next_character(caret, end);
    while (caret - start > SHOWN_AROUND)
        start = next_character(start, end);
    for (stop = caret; !is_line_end(stop, end) && stop - caret < SHOWN_AROUND;)
        stop = next_character(stop, end);

    char shown[ESCAPED_SIZE];
    for (const char *at = start; at < stop;) {
        at += show(at, (size_t)(stop - at), shown);
        fputs(shown, stderr);
    }
    fputc('\n', stderr);
    while (start < caret) {
        const size_t taken = show(start, (size_t)(stop - start), shown);
        const bool as_it_is = strlen(shown) == taken && memcmp(shown, start, taken) == 0;
        fprintf(stderr, "%*s", as_it_is ? 1 : (int)strlen(shown), *start == '\t' ? "\t" : "");
        start += taken;
    }
    fputs("^\n", stderr);
}

void report_print(struct diagnostics *report)
{
    flockfile(stderr);
    for (size_t i = 0; i < report->count && i < REPORT_MAX_ERRORS; i++) {
        const struct scene_error *error = &report->errors[i];
        report_line("%s:%d:%d: error: %s", report->path, error->place.line, error->place.column,
                    error->message ? error->message : "");
        print_line_and_caret(report, error->place);
    }
    if (report->count > REPORT_MAX_ERRORS)
        report_line("%s: error: %zu more errors", report->path, report->count - REPORT_MAX_ERRORS);
    funlockfile(stderr);
    report_discard(report);
}

void report_discard(struct diagnostics *report)
{
    for (size_t i = 0; i < report->count && i < REPORT_MAX_ERRORS; i++)
        free(report->errors[i].message);
    report->count = 0;
}

const char *report_quote(const char *text, size_t length, char out[REPORT_QUOTE_SIZE])
{
    static const char ellipsis[] = "...";
    const size_t room = REPORT_QUOTE_SIZE - 2 - sizeof(ellipsis);
    size_t kept = length;
    if (length > room)
        for (kept = room; kept > 0 && is_continuation(text[kept]); kept--)
            ;
    out[0] = '"';
    for (size_t i = 0; i < kept; i++)
        out[1 + i] = text[i] ? text[i] : '?'; /* the end of a string here, but not in YAML */
    snprintf(out + 1 + kept, REPORT_QUOTE_SIZE - 1 - kept, "%s\"", kept < length ? ellipsis : "");
    return out;
}
