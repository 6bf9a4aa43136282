#include "scene/npy_header.h"

#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* The header is a Python dictionary: {'descr': '<f4', 'fortran_order': False, 'shape': (17, 4), }. */

enum { QUOTED = 48 }; /* bytes of it that a message shows at most */

struct parsing {
    const char *at, *end;
    struct npy_header *header;
    char *message;
    bool has_descr, has_order, has_shape;
};

static const uint64_t most_rows = UINT64_C(1) << 48;

/* Refuses with the text from start to end after the message, for "..., is %s". */
static enum status refuse_text(const struct parsing *parsing, const char *what, const char *start,
                               const char *end)
{
    char text[QUOTED + 1];
    size_t length = end - start < QUOTED ? (size_t)(end - start) : QUOTED;
    for (size_t i = 0; i < length; ++i)
        text[i] = start[i] >= 0x20 && start[i] < 0x7F ? start[i] : '?';
    text[length] = 0;
    snprintf(parsing->message, NPY_MESSAGE, "%s, is %s%s", what, text, end - start > QUOTED ? "..." : "");
    return STATUS_REFUSED;
}

static enum status refuse(const struct parsing *parsing, const char *what)
{
    snprintf(parsing->message, NPY_MESSAGE, "%s", what);
    return STATUS_REFUSED;
}

static enum status refuse_header(const struct parsing *parsing, const char *what)
{
    snprintf(parsing->message, NPY_MESSAGE, "its NumPy header is wrong: %s", what);
    return STATUS_REFUSED;
}

static void skip_space(struct parsing *parsing)
{
    while (parsing->at < parsing->end &&
           (*parsing->at == ' ' || *parsing->at == '\t' || *parsing->at == '\n'))
        ++parsing->at;
}

/* Takes the character, with space around it, if it is the next one. */
static bool take(struct parsing *parsing, char character)
{
    skip_space(parsing);
    if (parsing->at == parsing->end || *parsing->at != character)
        return false;
    ++parsing->at;
    skip_space(parsing);
    return true;
}

static bool take_word(struct parsing *parsing, const char *word)
{
    size_t length = strlen(word);
    if ((size_t)(parsing->end - parsing->at) < length || memcmp(parsing->at, word, length) != 0)
        return false;
    parsing->at += length;
    return true;
}

/* A text in quotes, without escapes. */
static bool take_string(struct parsing *parsing, const char **start, size_t *length)
{
    const char quote = parsing->at < parsing->end ? *parsing->at : 0;
    if (quote != '\'' && quote != '"')
        return false;
    *start = parsing->at + 1;
    const char *end = memchr(*start, quote, (size_t)(parsing->end - *start));
    if (!end)
        return false;
    *length = (size_t)(end - *start);
    parsing->at = end + 1;
    return true;
}

static enum status parse_descr(struct parsing *parsing)
{
    static const char expected[] = "its dtype must be float32 or float64";
    const char *written = parsing->at, *start;
    size_t length;
    if (!take_string(parsing, &start, &length)) {
        const char *end = memchr(written, ']', (size_t)(parsing->end - written));
        if (end && *written == '[') /* structured */
            return refuse_text(parsing, expected, written, end + 1);
        return refuse_header(parsing, "'descr' must be a text");
    }
    if (length > 1 && memchr("|<>=", start[0], 4) && start[1] == 'O')
        return refuse(parsing, "holds pickled Python objects, which are not read");
    if (length != 3 || (start[0] != '<' && start[0] != '>') || start[1] != 'f' ||
        (start[2] != '4' && start[2] != '8'))
        return refuse_text(parsing, expected, written, parsing->at);
    parsing->header->big_endian = start[0] == '>';
    parsing->header->value_size = start[2] == '4' ? 4 : 8;
    return STATUS_DONE;
}

static enum status parse_order(struct parsing *parsing)
{
    parsing->header->columns_first = take_word(parsing, "True");
    if (!parsing->header->columns_first && !take_word(parsing, "False"))
        return refuse_header(parsing, "'fortran_order' must be True or False");
    return STATUS_DONE;
}

/* A number of decimal digits; Python 2 wrote an L behind it. Beyond what a file can hold it is cut. */
static bool take_number(struct parsing *parsing, uint64_t *number)
{
    const char *start = parsing->at;
    for (*number = 0; parsing->at < parsing->end && isdigit((unsigned char)*parsing->at); ++parsing->at)
        *number = *number > most_rows ? *number : 10 * *number + (uint64_t)(*parsing->at - '0');
    bool good = parsing->at > start;
    take_word(parsing, "L");
    return good;
}

static enum status parse_shape(struct parsing *parsing)
{
    const char *start = parsing->at;
    uint64_t sizes[2] = {0, 0};
    size_t dimensions = 0;
    if (!take(parsing, '('))
        return refuse_header(parsing, "'shape' must be a tuple");
    while (parsing->at < parsing->end && *parsing->at != ')') {
        uint64_t number;
        if (!take_number(parsing, &number))
            return refuse_header(parsing, "'shape' must have whole numbers");
        if (dimensions < 2)
            sizes[dimensions] = number;
        ++dimensions;
        if (!take(parsing, ',') && parsing->at < parsing->end && *parsing->at != ')')
            return refuse_header(parsing, "'shape' must be a tuple");
    }
    if (!take_word(parsing, ")"))
        return refuse_header(parsing, "'shape' must be a tuple");
    if (dimensions != 2 || sizes[1] != NPY_COLUMNS || sizes[0] > most_rows)
        return refuse_text(parsing, "its shape must be (N, 4): x, y, z, radius", start, parsing->at);
    parsing->header->rows = (size_t)sizes[0];
    return STATUS_DONE;
}

static enum status parse_item(struct parsing *parsing)
{
    const struct {
        const char *key;
        enum status (*parse)(struct parsing *);
        bool *found;
    } items[] = {{"descr", parse_descr, &parsing->has_descr},
                 {"fortran_order", parse_order, &parsing->has_order},
                 {"shape", parse_shape, &parsing->has_shape}};
    const char *key;
    size_t length;
    if (!take_string(parsing, &key, &length) || !take(parsing, ':'))
        return refuse_header(parsing, "it must be a dictionary");
    for (size_t i = 0; i < sizeof items / sizeof *items; ++i)
        if (length == strlen(items[i].key) && memcmp(key, items[i].key, length) == 0) {
            if (*items[i].found)
                return refuse_header(parsing, "a key is given twice");
            *items[i].found = true;
            return items[i].parse(parsing);
        }
    return refuse_header(parsing, "the keys are 'descr', 'fortran_order' and 'shape'");
}

static enum status parse_dictionary(struct parsing *parsing)
{
    bool more = true;
    if (!take(parsing, '{'))
        return refuse_header(parsing, "it must be a dictionary");
    while (!take(parsing, '}')) {
        enum status status = more ? parse_item(parsing) : refuse_header(parsing, "a comma is missing");
        if (status != STATUS_DONE)
            return status;
        more = take(parsing, ',');
    }
    skip_space(parsing);
    if (parsing->at != parsing->end)
        return refuse_header(parsing, "something follows the dictionary");
    if (!parsing->has_descr || !parsing->has_order || !parsing->has_shape)
        return refuse_header(parsing, "it must have 'descr', 'fortran_order' and 'shape'");
    return STATUS_DONE;
}

enum status npy_header_parse(const char *text, size_t length, struct npy_header *header,
                             char message[NPY_MESSAGE])
{
    const unsigned char *bytes = (const unsigned char *)text;
    struct parsing parsing = {.header = header, .message = message};
    if (length < 10 || memcmp(text, "\x93NUMPY", 6) != 0) {
        snprintf(message, NPY_MESSAGE, "is not a NumPy file (.npy)");
        return STATUS_REFUSED;
    }
    if (bytes[6] < 1 || bytes[6] > 3 || bytes[7] != 0) {
        snprintf(message, NPY_MESSAGE, "has version %d.%d of NumPy's format; 1.0, 2.0 and 3.0 are known",
                 bytes[6], bytes[7]);
        return STATUS_REFUSED;
    }
    size_t before = bytes[6] == 1 ? 10 : 12;
    size_t dictionary = (size_t)(bytes[8] | bytes[9] << 8);
    if (bytes[6] > 1 && length >= 12)
        dictionary |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
    if (dictionary > NPY_MOST_HEADER - before) {
        snprintf(message, NPY_MESSAGE, "has a header of %zu bytes, more than %d", dictionary,
                 NPY_MOST_HEADER);
        return STATUS_REFUSED;
    }
    if (before + dictionary > length) {
        snprintf(message, NPY_MESSAGE, "is truncated: it ends in its header");
        return STATUS_REFUSED;
    }
    *header = (struct npy_header){.size = before + dictionary};
    parsing.at = text + before;
    parsing.end = parsing.at + dictionary;
    return parse_dictionary(&parsing);
}
