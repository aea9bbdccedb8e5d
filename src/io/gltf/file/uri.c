#include "io/gltf/file/uri.h"
#include "base/text/buffer.h"
#include <string.h>

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

bool ffd_uri_starts_with(const char *text, const char *word)
{
    for (; *word; text++, word++)
        if (*text != *word && !(is_letter(*text) && (*text | 0x20) == *word))
            return false;
    return true;
}

bool ffd_uri_is_data(const char *uri)
{
    return ffd_uri_starts_with(uri, "data:");
}

bool ffd_uri_is_absolute(const char *uri)
{
    if (uri[0] == '/' || uri[0] == '\\')
        return true;
    if (!is_letter(uri[0]))
        return false;
    while (is_letter(*uri) || is_digit(*uri) || *uri == '+' || *uri == '-' || *uri == '.')
        uri++;
    return *uri == ':';
}

static int hex_value(char c)
{
    if (is_digit(c))
        return c - '0';
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

size_t ffd_uri_decode(char *text, size_t size)
{
    const char *const escape = memchr(text, '%', size);
    size_t length = escape ? (size_t)(escape - text) : size;
    for (size_t i = length; i < size; i++) {
        const int high = text[i] == '%' && size - i > 2 ? hex_value(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
        if (low >= 0) {
            text[length++] = (char)(high * 16 + low);
            i += 2;
        } else {
            text[length++] = text[i];
        }
    }
    return length;
}

char *ffd_uri_encode(const char *path)
{
    byte_buffer out = {0};
    for (const char *c = path; *c; c++) {
        if (is_letter(*c) || is_digit(*c) || strchr("-._~/", *c))
            ffd_buffer_append(&out, c, 1);
        else
            ffd_buffer_format(&out, "%%%02X", (unsigned)(unsigned char)*c);
    }
    return ffd_buffer_finish(&out);
}
