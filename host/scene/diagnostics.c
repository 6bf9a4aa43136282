#include "scene/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOWN_BEFORE = 100, SHOWN_AFTER = 100 }; /* bytes of a long line on either side of the caret */

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
    report->count++;
    if (report->kept == REPORT_MAX_ERRORS)
        return;

    char *message = NULL;
    va_list arguments;
    va_start(arguments, format);
    int written = vasprintf(&message, format, arguments);
    va_end(arguments);
    if (written < 0) {
        report->no_memory = true;
        return;
    }
    size_t at = report->kept++;
    for (; at > 0 && precedes(place, report->errors[at - 1].place); at--)
        report->errors[at] = report->errors[at - 1];
    report->errors[at] = (struct scene_error){.place = place, .message = message};
}

/* The line's first byte and its length without the line break; "" for a line that is not there. */
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

static void print_line_and_caret(const struct diagnostics *report, struct scene_place place)
{
    size_t length;
    const char *line = find_line(report, place.line, &length);
    size_t caret = 0;
    for (int column = 1; column < place.column && caret < length; column++)
        do
            caret++;
        while (caret < length && is_continuation(line[caret]));

    size_t start = caret > SHOWN_BEFORE ? caret - SHOWN_BEFORE : 0;
    while (start < caret && is_continuation(line[start]))
        start++;
    size_t stop = length - caret > SHOWN_AFTER ? caret + SHOWN_AFTER : length;
    while (stop < length && is_continuation(line[stop]))
        stop++;

    fwrite(line + start, 1, stop - start, stderr);
    fputc('\n', stderr);
    for (size_t i = start; i < caret; i++)
        if (!is_continuation(line[i]))
            fputc(line[i] == '\t' ? '\t' : ' ', stderr);
    fputs("^\n", stderr);
}

void report_print(const struct diagnostics *report)
{
    flockfile(stderr);
    for (size_t i = 0; i < report->kept; i++) {
        const struct scene_error *error = &report->errors[i];
        fprintf(stderr, "%s:%d:%d: error: %s\n", report->path, error->place.line, error->place.column,
                error->message);
        print_line_and_caret(report, error->place);
    }
    if (report->count > report->kept)
        fprintf(stderr, "%s: error: %zu more errors\n", report->path, report->count - report->kept);
    funlockfile(stderr);
}

void report_clear(struct diagnostics *report)
{
    for (size_t i = 0; i < report->kept; i++)
        free(report->errors[i].message);
    report->kept = report->count = 0;
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
        bool c1_control = byte == 0xC2 && i + 1 < kept && (unsigned char)text[i + 1] < 0xA0;
        out[1 + i] = byte < 0x20 || byte == 0x7F || c1_control ? '?' : text[i];
        if (c1_control)
            out[1 + ++i] = '?';
    }
    snprintf(out + 1 + kept, REPORT_QUOTE_SIZE - 1 - kept, "%s\"", kept < length ? ellipsis : "");
    return out;
}
