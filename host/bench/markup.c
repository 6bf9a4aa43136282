#include "bench/markup.h"

#include <math.h>
#include <string.h>

void markup_text(FILE *out, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            if ((unsigned char)*text < 0x20 && *text != '\n' && *text != '\t')
                fputs("\xEF\xBF\xBD", out);
            else
                fputc(*text, out);
        }
    }
}

const char *markup_error(double error, char buffer[MARKUP_NUMBER_SIZE])
{
    if (error == 0.0)
        return strcpy(buffer, "0");
    if (!isfinite(error))
        return strcpy(buffer, "∞");
    if (error >= 0.0995 && error < 999.5) {
        snprintf(buffer, MARKUP_NUMBER_SIZE, "%.*f", error < 0.995 ? 2 : error < 9.95 ? 1 : 0, error);
        return buffer;
    }
    snprintf(buffer, MARKUP_NUMBER_SIZE, "%.1e", error); /* 1.2e-05 */
    char *sign = strchr(buffer, 'e') + 1;
    const char *digits = sign + 1 + strspn(sign + 1, "0");
    char *end = *sign == '-' ? sign + 1 : sign;
    memmove(end, *digits ? digits : "0", strlen(*digits ? digits : "0") + 1);
    return buffer;
}

/* Puts a narrow no-break space before each three of the digits in front of the point. */
static const char *group_thousands(const char *digits, char *buffer)
{
    static const char space[] = "\xE2\x80\xAF";
    size_t start = digits[0] == '-', whole = strcspn(digits + start, ".");
    char *end = buffer;
    for (size_t i = 0; digits[i]; i++) {
        if (i > start && i < start + whole && (start + whole - i) % 3 == 0)
            end = stpcpy(end, space);
        *end++ = digits[i];
    }
    *end = '\0';
    return buffer;
}

const char *markup_number(double number, char buffer[MARKUP_NUMBER_SIZE])
{
    if (!(fabs(number) < 1e15))
        return strcpy(buffer, "–");
    if (number > 0.0 && number < 1e-3)
        return markup_error(number, buffer);
    char digits[MARKUP_NUMBER_SIZE];
    int before_point = number == 0.0 ? 3 : (int)floor(log10(fabs(number))) + 1;
    snprintf(digits, sizeof digits, "%.*f", before_point < 3 ? 3 - before_point : 0, number);
    return group_thousands(digits, buffer);
}

const char *markup_count(double count, char buffer[MARKUP_NUMBER_SIZE])
{
    if (!(fabs(count) < 1e15))
        return strcpy(buffer, "–");
    char digits[MARKUP_NUMBER_SIZE];
    snprintf(digits, sizeof digits, "%.0f", count);
    return group_thousands(digits, buffer);
}
