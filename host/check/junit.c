#include "check/junit.h"

#include <stdlib.h>
#include <string.h>

#include "base/escape.h"
#include "base/output_file.h"

/* Writes the text as a part of an attribute's value. */
static void put_text(FILE *stream, const char *text)
{
    char shown[ESCAPED_SIZE];
    size_t left = strlen(text);
    for (size_t taken; left > 0; text += taken, left -= taken) {
        taken = escape_character(text, left, shown);
        if (strchr("&<>\"", *shown))
            fprintf(stream, "&#%d;", *shown);
        else
            fputs(shown, stream);
    }
}

void junit_create(struct junit *junit)
{
    *junit = (struct junit){0};
    junit->cases = open_memstream(&junit->text, &junit->size);
}

void junit_add(struct junit *junit, const char *scene, double seconds, enum status outcome,
               const char *reason)
{
    ++junit->tests;
    if (!junit->cases)
        return;
    fputs("    <testcase classname=\"vkwhitted check\" name=\"", junit->cases);
    put_text(junit->cases, scene);
    fprintf(junit->cases, "\" time=\"%.3f\">", seconds);
    if (outcome == STATUS_DIFFERS) {
        ++junit->failures;
        fputs("<failure message=\"", junit->cases);
        put_text(junit->cases, reason);
        fputs("\"/>", junit->cases);
    } else if (outcome != STATUS_DONE) {
        ++junit->errors;
        fprintf(junit->cases, "<error message=\"%s; standard error says why\"/>",
                outcome == STATUS_REFUSED ? "the scene was refused" : "the machine could not do it");
    }
    fputs("</testcase>\n", junit->cases);
}

enum status junit_write(struct junit *junit, const char *path)
{
    struct output_file file;
    const bool complete = junit->cases && fclose(junit->cases) == 0;
    enum status status = complete ? STATUS_DONE : STATUS_UNABLE;
    if (!complete)
        log_error("%s: no memory for the report", path ? path : "JUnit");
    else if (path)
        status = output_file_open(path, &file);
    if (status == STATUS_DONE && path) {
        fprintf(file.stream,
                "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
                "  <testsuite name=\"vkwhitted check\" tests=\"%u\" failures=\"%u\" errors=\"%u\">\n"
                "%s  </testsuite>\n</testsuites>\n",
                junit->tests, junit->failures, junit->errors, junit->text);
        status = output_file_commit(&file);
    }
    free(junit->text);
    *junit = (struct junit){0};
    return status;
}
