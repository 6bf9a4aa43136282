/* write_report DOCUMENT PAGE.html CHART.svg: writes the report of a bench document, and the chart of its
 * first scene. */
#include <stdio.h>

#include "bench/report.h"

int main(int argc, char **argv)
{
    json_error_t error;
    json_t *document = argc == 4 ? json_load_file(argv[1], 0, &error) : NULL;
    if (!document) {
        fprintf(stderr, "usage: write_report DOCUMENT PAGE.html CHART.svg, or DOCUMENT is no JSON\n");
        return STATUS_REFUSED;
    }
    enum status status = report_write(document, argv[2]);
    if (status == STATUS_DONE)
        status = chart_write(json_array_get(json_object_get(document, "scenes"), 0), argv[3]);
    json_decref(document);
    return (int)status;
}
