#include "base/escape.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "base/write.h"

size_t utf8_decode(const char *text, size_t length, uint32_t *code)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char lead = (unsigned char)text[0];
    const size_t size = lead < 0x80   ? 1
                        : lead < 0xC2 ? 0
                        : lead < 0xE0 ? 2
                        : lead < 0xF0 ? 3
                        : lead < 0xF5 ? 4
                                      : 0;
    if (size == 0 || size > length)
        return 0;
    *code = size == 1 ? lead : lead & (0xFFU >> (size + 1));
    for (size_t i = 1; i < size; ++i) {
        if (((unsigned char)text[i] & 0xC0) != 0x80)
            return 0;
        *code = *code << 6 | ((unsigned char)text[i] & 0x3FU);
    }
    const bool surrogate = *code >= 0xD800 && *code <= 0xDFFF;
    return *code >= least[size] && *code <= 0x10FFFF && !surrogate ? size : 0;
}

/* C0, DEL and C1; the marks of Unicode's bidirectional algorithm (UAX #9); separators of lines; what is never
 * a character, and not allowed in XML. */
static bool is_control(uint32_t code)
{
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || code == 0x61C || code == 0x200E ||
           code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
           code == 0xFFFE || code == 0xFFFF;
}

size_t escape_character(const char *text, size_t length, char shown[ESCAPED_SIZE])
{
    uint32_t code;
    const size_t size = utf8_decode(text, length, &code);
    if (size == 0) {
        snprintf(shown, ESCAPED_SIZE, "\\x%02x", (unsigned char)text[0]);
        return 1;
    }
    if (is_control(code)) {
        snprintf(shown, ESCAPED_SIZE, code < 0x80 ? "\\x%02x" : "\\u%04x", code);
    } else {
        memcpy(shown, text, size);
        shown[size] = '\0';
    }
    return size;
}

void escape_line(FILE *stream, const char *text)
{
    char shown[ESCAPED_SIZE];
    size_t length = strlen(text);
    for (size_t taken; length > 0; text += taken, length -= taken) {
        taken = escape_character(text, length, shown);
        fputs(shown, stream);
    }
    fputc('\n', stream);
}

/* A standard stream behind one that escapes. It gets whole lines, of which one of more than BUFSIZ bytes may
 * be cut in a character. */
struct escaped_stream {
    int descriptor, error;
};

static ssize_t write_escaped(void *cookie, const char *bytes, size_t size)
{
    struct escaped_stream *stream = cookie;
    for (size_t at = 0; at < size;) {
        char out[4096];
        size_t put = 0;
        while (at < size && put + ESCAPED_SIZE <= sizeof out)
            if (bytes[at] == '\n' || bytes[at] == '\t') {
                out[put++] = bytes[at++];
            } else {
                at += escape_character(bytes + at, size - at, out + put);
                put += strlen(out + put);
            }
        if (!write_all(stream->descriptor, out, put, &stream->error))
            return 0;
    }
    return (ssize_t)size;
}

static struct escaped_stream streams[2];

void escape_streams(void)
{
    FILE **const standard[] = {&stdout, &stderr};
    for (int i = 0; i < 2; ++i) {
        streams[i].descriptor = STDOUT_FILENO + i;
        FILE *escaped = fopencookie(&streams[i], "w", (cookie_io_functions_t){.write = write_escaped});
        if (!escaped)
            continue;
        setvbuf(escaped, NULL, _IOLBF, BUFSIZ);
        *standard[i] = escaped;
    }
}

bool escape_flush_output(void)
{
    const bool flushed = fflush(stdout) == 0;
    errno = streams[0].error ? streams[0].error : errno;
    return flushed && streams[0].error == 0;
}
