/* write_report DOCUMENT PAGE.html: writes the report of a bench document. */
#include <stdio.h>

#include "bench/report.h"

int main(int argc, char **argv)
{
    json_error_t error;
    json_t *document = argc == 3 ? json_load_file(argv[1], 0, &error) : NULL;
    if (!document) {
        fprintf(stderr, "usage: write_report DOCUMENT PAGE.html, or DOCUMENT is no JSON\n");
        return STATUS_REFUSED;
    }
    enum status status = report_write(document, argv[2]);
    json_decref(document);
    return (int)status;
}
