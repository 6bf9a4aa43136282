#ifndef VKWHITTED_CLI_OPTION_TABLE_H
#define VKWHITTED_CLI_OPTION_TABLE_H

#include "cli/options.h"

enum { COMMAND_NAMES = 64 }; /* characters that the names of all commands take */

/* Writes the names of a set of commands, in which 1 << COMMAND_... are the bits, separated by ", ". */
const char *command_names(unsigned set, char names[static COMMAND_NAMES]);

/* One option of the command line. Parsing and --help are made from the table of these; the manual page and
 * the completions of shells are made from --help when the program is built, see documents.cmake. */
struct option_entry {
    const char *name;  /* "": has a letter only */
    char letter[2];    /* "": has a long name only */
    unsigned commands; /* that take it, as for command_names(); those of one set stand together */
    const char *value; /* as --help shows it; NULL: takes none. For a choice the words, separated by | */

    /* Puts the value to its place in struct options. False (reported) where it is none for this option. */
    bool (*read)(const struct option_entry *option, const char *value, void *place);
    size_t offset;        /* of the place */
    unsigned least, most; /* of a number; most is 0 for everything else */
    const char *help;     /* lines after the first are indented */
};
extern const struct option_entry option_table[]; /* ends with one without help */

enum { OPTION_COUNT_MAX = 63 };

/* The value is the path of a file that is written; command_line_read() sees that it is no other one. */
bool read_output_file(const struct option_entry *option, const char *value, void *place);

/* Splits text at the separator into exactly `count` whole numbers up to most. */
bool parse_list(const char *text, char separator, size_t count, unsigned long most, unsigned *values);

#endif
