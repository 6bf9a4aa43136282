#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "base/output_file.h"
#include "cli/options.h"
#include "fuzz.h"

enum { MOST_WORDS = 64 };

/* The words behind the program's name, one a line. Outputs that they name are tried, in the working folder.
 */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = calloc(size + 1, 1), *words[MOST_WORDS + 1] = {(char[]){"vkwhitted"}}, *rest = text;
    int count = 1;
    if (!text)
        abort();
    memcpy(text, data, size);
    while (rest && count < MOST_WORDS)
        words[count++] = strsep(&rest, "\n");
    optind = 0; /* getopt_long() begins anew */
    struct options options;
    enum status status = command_line_read(count, words, &options);
    if (status == STATUS_DONE && !options.help && !options.version &&
        (options.command >= COMMAND_COUNT ||
         (options.scene_count == 0) != (options.command == COMMAND_DEVICES)))
        abort();
    if (status != STATUS_DONE && status != STATUS_REFUSED && status != STATUS_UNABLE)
        abort();
    output_file_release();
    options_destroy(&options);
    free(text);
    return 0;
}
