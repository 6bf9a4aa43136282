/* json_get FILE [KEY|INDEX]...: prints the value at that place of a JSON file, a string without quotes; for
 * arrays and objects their size. Exit status 1 where there is no such value or the file is no JSON. */
#include <stdio.h>
#include <stdlib.h>

#include <jansson.h>

int main(int argc, char **argv)
{
    json_error_t error;
    json_t *document = json_load_file(argc > 1 ? argv[1] : "", JSON_REJECT_DUPLICATES, &error);
    const json_t *value = document;
    for (int i = 2; i < argc && value; ++i)
        value = json_is_array(value) ? json_array_get(value, strtoul(argv[i], NULL, 10))
                                     : json_object_get(value, argv[i]);
    if (!document)
        fprintf(stderr, "json_get: %s:%d: %s\n", argc > 1 ? argv[1] : "", error.line, error.text);
    else if (!value)
        fprintf(stderr, "json_get: %s: no value there\n", argv[1]);
    else if (json_is_string(value))
        puts(json_string_value(value));
    else if (json_is_integer(value))
        printf("%lld\n", (long long)json_integer_value(value));
    else if (json_is_real(value))
        printf("%.17g\n", json_real_value(value));
    else if (json_is_boolean(value))
        puts(json_is_true(value) ? "true" : "false");
    else
        printf("%zu\n", json_is_array(value) ? json_array_size(value) : json_object_size(value));
    int status = value ? 0 : 1;
    json_decref(document);
    return status;
}
