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

    fprintf(stderr, "%.*s\n", (int)(stop - start), start);
    for (; start < caret; start = next_character(start, end))
        fputc(*start == '\t' ? '\t' : ' ', stderr);
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
