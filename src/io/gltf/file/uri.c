#include "io/gltf/file/uri.h"
#include "base/memory/memory.h"
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

bool ffd_uri_is_data(const char *uri)
{
    static const char scheme[] = "data:";
    for (size_t i = 0; i < sizeof scheme - 1; i++)
        if (uri[i] != scheme[i] && !(is_letter(uri[i]) && (uri[i] | 0x20) == scheme[i]))
            return false;
    return true;
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

char *ffd_path_normalize(const char *path)
{
    char *out = ffd_alloc(strlen(path) + 1, 1);
    if (!out)
        return NULL;
    size_t length = 0, kept = 0; /* kept: length of the leading "/" or "../" */
    const bool absolute = *path == '/';
    if (absolute)
        out[length++] = *path++;
    kept = length;
    while (*path) {
        size_t part = strcspn(path, "/");
        const bool up = part == 2 && path[0] == '.' && path[1] == '.';
        if (up && length > kept) {
            while (length > kept && out[length - 1] != '/')
                length--;
            if (length > kept)
                length--;
        } else if (part > 0 && !(part == 1 && path[0] == '.') && !(up && absolute)) {
            if (length > 0 && out[length - 1] != '/')
                out[length++] = '/';
            memmove(out + length, path, part);
            length += part;
            if (up)
                kept = length;
        }
        path += part;
        path += *path == '/';
    }
    out[length] = 0;
    return out;
}

bool ffd_path_leads_out(const char *path)
{
    return strcmp(path, "..") == 0 || strncmp(path, "../", 3) == 0;
}

char *ffd_path_relative(const char *from, const char *to)
{
    size_t common = 0;
    for (size_t i = 0;; i++) {
        const bool from_ends = from[i] == 0 || from[i] == '/', to_ends = to[i] == 0 || to[i] == '/';
        if (from_ends && to_ends)
            common = i;
        if (from[i] != to[i] || from[i] == 0)
            break;
    }
    byte_buffer out = {0};
    for (const char *c = from + common; *c; c++)
        if (*c == '/' && c[1])
            ffd_buffer_text(&out, "../");
    to += common;
    ffd_buffer_text(&out, *to == '/' ? to + 1 : to);
    return ffd_buffer_finish(&out);
}
