#include "base/json.h"

#include <math.h>
#include <stdlib.h>

#include "base/output_file.h"

json_t *json_real_or_null(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

enum status json_write(json_t *value, const char *path)
{
    char *text = value ? json_dumps(value, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(value);
    if (!text) {
        log_error("%s: no memory for the JSON text, or a string in it is not UTF-8", path);
        return STATUS_UNABLE;
    }
    struct output_file file;
    enum status status = output_file_open(path, &file);
    if (status == STATUS_DONE) {
        fprintf(file.stream, "%s\n", text);
        status = output_file_commit(&file);
    }
    free(text);
    return status;
}
