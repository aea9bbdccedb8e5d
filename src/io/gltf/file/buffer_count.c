#include "io/gltf/file/buffer_count.h"
#include "io/gltf/file/uri.h"
#include <stdbool.h>
#include <string.h>

/* The content of a string, without its quotes. */
typedef struct quoted {
    const char *begin, *end;
} quoted;

/* Reads the string whose opening quote is at c; returns the character after it. */
static const char *take_string(const char *c, const char *end, quoted *string)
{
    string->begin = ++c;
    for (;;) {
        const char *const quote = memchr(c, '"', (size_t)(end - c));
        const char *before = quote;
        while (before && before > string->begin && before[-1] == '\\')
            before--;
        string->end = quote ? quote : end;
        if (!quote || (quote - before) % 2 == 0)
            return quote ? quote + 1 : end;
        c = quote + 1;
    }
}

static bool is_word(const quoted *string, const char *word)
{
    const size_t length = strlen(word);
    return (size_t)(string->end - string->begin) == length && memcmp(string->begin, word, length) == 0;
}

static bool is_data(const quoted *string)
{
    char start[8] = "";
    const size_t length = (size_t)(string->end - string->begin);
    memcpy(start, string->begin, length < sizeof start - 1 ? length : sizeof start - 1);
    return ffd_uri_is_data(start);
}

size_t ffd_gltf_count_buffer_files(const char *text, size_t size)
{
    const char *c = text, *const end = text + size;
    size_t count = 0, depth = 0;
    bool in_buffers = false, is_uri = false; /* is_uri: the next value is that of "uri" */
    quoted string;
    while (c < end) {
        if (*c == '"') {
            c = take_string(c, end, &string);
            count += is_uri && !is_data(&string);
            is_uri = in_buffers && depth == 3 && !is_uri && is_word(&string, "uri");
            if (depth == 1)
                in_buffers = is_word(&string, "buffers");
            continue;
        }
        if (*c == '{' || *c == '[')
            depth++;
        else if ((*c == '}' || *c == ']') && depth > 0)
            depth--;
        if (*c == ',' && depth == 1)
            in_buffers = false;
        is_uri = is_uri && (*c == ':' || strchr(" \t\r\n", *c));
        c++;
    }
    return count;
}
