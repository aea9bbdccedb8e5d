#include "json/json_text.h"
#include "json/json_chars.h"
#include <assert.h>
#include <math.h>
#include <string.h>

void ffd_json_begin(json_text *json, byte_buffer *out)
{
    memset(json, 0, sizeof *json);
    json->out = out;
    json->empty[0] = true;
}

static void line_break(json_text *json)
{
    ffd_buffer_append(json->out, "\n", 1);
    for (int i = 0; i < json->depth; i++)
        ffd_buffer_append(json->out, "  ", 2);
}

/* Returns the end of the characters that need no escape. */
static const char *pass_plain(const char *c)
{
    while (*c >= ' ' && *c < 0x7f && *c != '"' && *c != '\\')
        c++;
    return c;
}

/* File names are arbitrary bytes: invalid UTF-8 becomes the replacement character, so that the output is
   valid JSON. */
static void quoted(byte_buffer *out, const char *text)
{
    const char *c = pass_plain(text), *const last = c + strlen(c);
    ffd_buffer_append(out, "\"", 1);
    ffd_buffer_append(out, text, (size_t)(c - text));
    for (const char *next; c < last; c = next) {
        uint32_t code;
        next = ffd_utf8_read(c, last, &code);
        if (!next || next > c + 1) {
            ffd_buffer_append(out, next ? c : "\xef\xbf\xbd", next ? (size_t)(next - c) : 3);
            next = next ? next : c + 1;
            continue;
        }
        if (*c == '"' || *c == '\\')
            ffd_buffer_format(out, "\\%c", *c);
        else if (*c == '\n')
            ffd_buffer_text(out, "\\n");
        else if (*c == '\t')
            ffd_buffer_text(out, "\\t");
        else if (code < 0x20 || code == 0x7f)
            ffd_buffer_format(out, "\\u%04x", (unsigned)code);
        else
            ffd_buffer_append(out, c, 1);
    }
    ffd_buffer_append(out, "\"", 1);
}

/* Writes what precedes a value: comma, line break, indentation, key. */
static void lead_in(json_text *json, const char *key)
{
    const bool first = json->empty[json->depth];
    json->empty[json->depth] = false;
    if (json->depth > 0) {
        if (!first)
            ffd_buffer_append(json->out, ",", 1);
        if (!json->inline_from[json->depth])
            line_break(json);
        else if (!first)
            ffd_buffer_append(json->out, " ", 1);
    }
    if (key) {
        quoted(json->out, key);
        ffd_buffer_append(json->out, ": ", 2);
    }
}

static void open_level(json_text *json, const char *key, bool on_one_line, const char *bracket)
{
    assert(json->depth + 1 < FFD_JSON_DEPTH);
    lead_in(json, key);
    ffd_buffer_text(json->out, bracket);
    const bool inherited = json->depth > 0 && json->inline_from[json->depth];
    json->depth++;
    json->inline_from[json->depth] = inherited || on_one_line;
    json->empty[json->depth] = true;
}

void ffd_json_object(json_text *json, const char *key, bool on_one_line)
{
    open_level(json, key, on_one_line, "{");
}

void ffd_json_array(json_text *json, const char *key, bool on_one_line)
{
    open_level(json, key, on_one_line, "[");
}

void ffd_json_end(json_text *json, char bracket)
{
    const bool on_one_line = json->inline_from[json->depth], empty = json->empty[json->depth];
    json->depth--;
    if (!on_one_line && !empty)
        line_break(json);
    ffd_buffer_append(json->out, &bracket, 1);
    if (json->depth == 0)
        ffd_buffer_text(json->out, "\n");
}

void ffd_json_string(json_text *json, const char *key, const char *value)
{
    lead_in(json, key);
    if (value)
        quoted(json->out, value);
    else
        ffd_buffer_text(json->out, "null");
}

void ffd_json_number(json_text *json, const char *key, double value)
{
    lead_in(json, key);
    if (isfinite(value))
        ffd_buffer_number(json->out, value);
    else
        ffd_buffer_text(json->out, "null");
}

void ffd_json_count(json_text *json, const char *key, uint64_t value)
{
    char digits[20], *const end = digits + sizeof digits, *first = end;
    lead_in(json, key);
    do
        *--first = (char)('0' + value % 10);
    while (value /= 10);
    ffd_buffer_append(json->out, first, (size_t)(end - first));
}

void ffd_json_counts(json_text *json, const json_count *members, size_t count)
{
    for (size_t i = 0; i < count; i++)
        ffd_json_count(json, members[i].key, members[i].count);
}

void ffd_json_bool(json_text *json, const char *key, bool value)
{
    lead_in(json, key);
    ffd_buffer_text(json->out, value ? "true" : "false");
}

void ffd_json_null(json_text *json, const char *key)
{
    ffd_json_string(json, key, NULL);
}

void ffd_json_raw(json_text *json, const char *key, const char *text, size_t size)
{
    lead_in(json, key);
    ffd_buffer_append(json->out, text, size);
}

void ffd_json_vector(json_text *json, const char *key, const double *values, size_t count)
{
    ffd_json_array(json, key, true);
    for (size_t i = 0; i < count; i++)
        ffd_json_number(json, NULL, values[i]);
    ffd_json_end(json, ']');
}

/* JSON strings contain no line breaks, so each line break is followed by indentation. */
void ffd_json_join_lines(const char *text, size_t size, byte_buffer *out)
{
    const char *const end = text + size;
    for (const char *line = text; line < end;) {
        const char *const found = memchr(line, '\n', (size_t)(end - line)), *const stop = found ? found : end;
        ffd_buffer_append(out, line, (size_t)(stop - line));
        const bool is_between = stop > line && stop[-1] == ',';
        for (line = stop; line < end && strchr(" \n", *line);)
            line++;
        if (is_between && line < end)
            ffd_buffer_text(out, " ");
    }
}
