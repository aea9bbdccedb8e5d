#include "base/text/number.h"
#include "job/info.h"
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#define INDENT 2
#define GAP 2

/* A walk over the facts: the first finds how wide the names are, the second writes. */
typedef struct renderer {
    byte_buffer *out; /* NULL in the first walk */
    size_t width;
} renderer;

/* Control characters would reach the terminal; the rest is UTF-8. */
static void write_string(byte_buffer *out, const char *text)
{
    for (const char *c = text; *c; c++)
        ffd_buffer_append(out, (unsigned char)*c < 0x20 || *c == 0x7f ? "?" : c, 1);
}

/* The number of characters. */
static size_t text_width(const char *text)
{
    size_t width = 0;
    for (const char *c = text; *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

static void write_scalar(byte_buffer *out, const json_t *value)
{
    if (json_is_string(value))
        write_string(out, json_string_value(value));
    else if (json_is_number(value))
        ffd_buffer_number(out, json_number_value(value));
    else if (json_is_boolean(value))
        ffd_buffer_text(out, json_is_true(value) ? "yes" : "no");
    else
        ffd_buffer_text(out, "none");
}

static bool has_inner_parts(const json_t *array)
{
    for (size_t i = 0; i < json_array_size(array); i++) {
        const json_t *value = json_array_get(array, i);
        if (json_is_object(value) || json_is_array(value))
            return true;
    }
    return false;
}

/* Numbers are told apart by spaces, names (which may hold spaces) by commas. */
static void write_value(byte_buffer *out, const json_t *value)
{
    const size_t count = json_array_size(value); /* 0 where it is no array */
    if (!json_is_array(value))
        write_scalar(out, value);
    else if (count == 0)
        ffd_buffer_text(out, "none");
    for (size_t i = 0; i < count; i++) {
        const json_t *element = json_array_get(value, i);
        if (i > 0)
            ffd_buffer_text(out, json_is_string(element) ? ", " : " ");
        write_scalar(out, element);
    }
}

static void write_spaces(byte_buffer *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        ffd_buffer_text(out, " ");
}

/* "boundary_loops" stands as "boundary loops". */
static void write_name(byte_buffer *out, const char *name)
{
    for (const char *c = name; *c; c++)
        ffd_buffer_append(out, *c == '_' || (unsigned char)*c < 0x20 ? " " : c, 1);
}

static void render_line(renderer *r, size_t depth, const char *name, const json_t *value)
{
    const size_t used = INDENT * depth + text_width(name);
    if (!r->out) {
        if (value && used > r->width)
            r->width = used;
        return;
    }
    write_spaces(r->out, INDENT * depth);
    write_name(r->out, name);
    if (value) {
        write_spaces(r->out, r->width + GAP - used);
        write_value(r->out, value);
    }
    ffd_buffer_text(r->out, "\n");
}

/* Depth is bounded by FFD_JSON_DEPTH, with which the JSON was written. */
static void render_member(renderer *r, size_t depth, const char *name, json_t *value)
{
    if (json_is_object(value) && json_object_size(value) > 0) {
        const char *key;
        json_t *member;
        render_line(r, depth, name, NULL);
        json_object_foreach(value, key, member) render_member(r, depth + 1, key, member);
    } else if (has_inner_parts(value)) {
        render_line(r, depth, name, NULL);
        for (size_t i = 0; i < json_array_size(value); i++) {
            char number[32];
            snprintf(number, sizeof number, "%zu", i);
            render_member(r, depth + 1, number, json_array_get(value, i));
        }
    } else
        render_line(r, depth, name, value);
}

static void render(renderer *r, json_t *facts)
{
    const char *key;
    json_t *member;
    json_object_foreach(facts, key, member) if (strcmp(key, "format") != 0 && strcmp(key, "version") != 0)
        render_member(r, 0, key, member);
}

ffd_status ffd_info_render(const char *json, size_t size, char **text, ffd_error *error)
{
    /* Whole numbers as doubles: ours can be larger than a JSON integer of the reader. The JSON is written by
       ourselves: it lacks nothing but memory to be read in, whatever jansson calls that. */
    json_t *facts = json_loadb(json, size, JSON_DECODE_INT_AS_REAL, NULL);
    if (!facts)
        return ffd_fail_memory(error);
    byte_buffer out = {0};
    renderer r = {0};
    render(&r, facts);
    r.out = &out;
    render(&r, facts);
    json_decref(facts);
    *text = ffd_buffer_finish(&out);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
