#include <string.h>

#include "base/output_file.h"
#include "bench/bench.h"
#include "report_html.h"

/* Texts may hold "</script" and "<!--", which would end or change the element around them. */
static int write_escaped(const char *text, size_t size, void *stream)
{
    for (size_t i = 0; i < size; ++i)
        fputs(text[i] == '<' ? "\\u003c" : (char[]){text[i], '\0'}, stream);
    return 0;
}

enum status report_write(const json_t *document, const char *path)
{
    static const char marker[] = "@BENCH@";
    const char *template = (const char *)report_html, *end = template + sizeof report_html;
    const char *place = memmem(template, sizeof report_html, marker, strlen(marker));
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status != STATUS_DONE)
        return status;
    fwrite(template, 1, (size_t)(place - template), file.stream);
    if (json_dump_callback(document, write_escaped, file.stream,
                           JSON_ENSURE_ASCII | JSON_REAL_PRECISION(9)) != 0) {
        output_file_abandon(&file);
        log_error("%s: no memory for the report", path);
        return STATUS_UNABLE;
    }
    place += strlen(marker);
    fwrite(place, 1, (size_t)(end - place), file.stream);
    return output_file_commit(&file);
}
