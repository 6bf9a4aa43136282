#include "check/junit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/output_file.h"

/* The bytes of the character that begins the text; 0: none begins there, or none that XML can hold. */
static size_t character_length(const char *text)
{
    static const uint32_t least[] = {0, 0x80, 0x800, 0x10000};
    const unsigned char *bytes = (const unsigned char *)text;
    const size_t more = bytes[0] < 0x80 ? 0 : bytes[0] >> 5 == 6 ? 1 : bytes[0] >> 4 == 14 ? 2 : 3;
    if (more == 0)
        return bytes[0] >= ' ';
    uint32_t code = bytes[0] & (0x3fu >> more);
    for (size_t i = 1; i <= more; ++i) {
        if (bytes[i] >> 6 != 2)
            return 0;
        code = code << 6 | (bytes[i] & 0x3fu);
    }
    const bool is_none = bytes[0] >= 0xf8 || code < least[more] || code > 0x10ffff ||
                         (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff;
    return is_none ? 0 : more + 1;
}

/* Writes the text as a part of an attribute's value. */
static void put_text(FILE *stream, const char *text)
{
    for (size_t length; *text; text += length > 0 ? length : 1) {
        length = character_length(text);
        if (length == 0 || strchr("&<>\"", *text))
            fprintf(stream, length > 0 ? "&#%d;" : "?", *text);
        else
            fwrite(text, 1, length, stream);
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

enum status junit_write(struct junit *junit, const char *device, const char *path)
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
                "    <properties><property name=\"device\" value=\"",
                junit->tests, junit->failures, junit->errors);
        put_text(file.stream, device);
        fprintf(file.stream, "\"/></properties>\n%s  </testsuite>\n</testsuites>\n", junit->text);
        status = output_file_commit(&file);
    }
    free(junit->text);
    *junit = (struct junit){0};
    return status;
}
