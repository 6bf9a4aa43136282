#include "scene/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* The line's first byte and its length without the line break. */
static const char *find_line(const struct diagnostics *report, int line, size_t *length)
{
    const char *at = report->text, *end = report->text + report->length;
    for (int i = 1; i < line && at < end; at++)
        if (*at == '\n' || (*at == '\r' && (at + 1 == end || at[1] != '\n')))
            i++;
    const char *stop = at;
    while (stop < end && *stop != '\n' && *stop != '\r')
        stop++;
    *length = (size_t)(stop - at);
    return at;
}

static size_t next_character(const char *line, size_t length, size_t at)
{
    do
        at++;
    while (at < length && is_continuation(line[at]));
    return at;
}

static void print_line_and_caret(const struct diagnostics *report, struct scene_place place)
{
    size_t length, caret = 0, start = 0, stop;
    const char *line = find_line(report, place.line, &length);
    for (int column = 1; column < place.column && caret < length; column++)
        caret = next_character(line, length, caret);
    while (caret - start > SHOWN_AROUND)
        start = next_character(line, length, start);
    for (stop = caret; stop < length && stop - caret < SHOWN_AROUND;)
        stop = next_character(line, length, stop);

    fprintf(stderr, "%.*s\n", (int)(stop - start), line + start);
    for (size_t i = start; i < caret; i = next_character(line, length, i))
        fputc(line[i] == '\t' ? '\t' : ' ', stderr);
    fputs("^\n", stderr);
}

void report_print(struct diagnostics *report)
{
    flockfile(stderr);
    for (size_t i = 0; i < report->count && i < REPORT_MAX_ERRORS; i++) {
        const struct scene_error *error = &report->errors[i];
        fprintf(stderr, "%s:%d:%d: error: %s\n", report->path, error->place.line, error->place.column,
                error->message ? error->message : "");
        print_line_and_caret(report, error->place);
        free(error->message);
    }
    if (report->count > REPORT_MAX_ERRORS)
        fprintf(stderr, "%s: error: %zu more errors\n", report->path, report->count - REPORT_MAX_ERRORS);
    funlockfile(stderr);
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
    for (size_t i = 0; i < kept; i++) {
        unsigned char byte = (unsigned char)text[i];
        bool c1_control = i > 0 && (unsigned char)text[i - 1] == 0xC2 && byte < 0xA0;
        out[1 + i] = byte < 0x20 || byte == 0x7F ? '?' : text[i];
        if (c1_control)
            out[i] = out[1 + i] = '?';
    }
    snprintf(out + 1 + kept, REPORT_QUOTE_SIZE - 1 - kept, "%s\"", kept < length ? ellipsis : "");
    return out;
}
