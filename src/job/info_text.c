/* info_text.c - the JSON of `ffd info` as text for people. */
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "base/text/words.h"
#include "job/info.h"
#include "json/json_parse.h"
#include <ffd/program.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define INDENT 2
#define GAP 2
/* Wider names do not widen the column: blanks beside all the others would be many times the file. */
#define WIDEST 100

/* A walk over the JSON. The first one measures the widest name up to WIDEST, the second one writes. */
typedef struct renderer {
    const json_tree *facts;
    byte_buffer *out; /* NULL in the first walk */
    size_t width;
    bool is_exact; /* write all digits of numbers: those that the file declares */
    bool failed;   /* out of memory */
} renderer;

/* Writes a number in six digits; whole ones, which may be counts, in full. */
static void write_number(const renderer *r, double number)
{
    if (r->is_exact || number == floor_of(number))
        ffd_buffer_number(r->out, number);
    else
        ffd_buffer_format(r->out, "%.6g", number);
}

/* Escapes control characters, which would reach the terminal. The rest is UTF-8. */
static void write_string(byte_buffer *out, const char *text)
{
    const size_t before = out->size;
    ffd_buffer_text(out, text);
    if (!out->failed)
        ffd_make_one_line(out->data + before, out->size - before);
}

/* Returns the number of characters. */
static size_t text_width(const char *text)
{
    size_t width = 0;
    for (const char *c = text; *c; c++)
        width += ((unsigned char)*c & 0xc0) != 0x80;
    return width;
}

static void write_scalar(renderer *r, uint32_t value)
{
    double number;
    switch ((json_kind)r->facts->values[value].kind) {
    case JSON_STRING: {
        char *const text = ffd_json_tree_string(r->facts, value, NULL);
        r->failed = r->failed || !text;
        write_string(r->out, text ? text : "");
        ffd_free(text);
        break;
    }
    case JSON_NUMBER:
        ffd_json_tree_number(r->facts, value, &number);
        write_number(r, number);
        break;
    case JSON_TRUE:
        ffd_buffer_text(r->out, "yes");
        break;
    case JSON_FALSE:
        ffd_buffer_text(r->out, "no");
        break;
    case JSON_NULL:
    case JSON_ARRAY:
    case JSON_OBJECT:
        ffd_buffer_text(r->out, "none");
    }
}

static bool is_kind(const renderer *r, uint32_t value, json_kind kind)
{
    return r->facts->values[value].kind == kind;
}

/* In a list of names null is a thing without one. */
static bool is_name(const renderer *r, uint32_t value)
{
    return is_kind(r, value, JSON_STRING) || is_kind(r, value, JSON_NULL);
}

static bool has_inner_parts(const renderer *r, uint32_t array)
{
    for (uint32_t v = ffd_json_tree_first(r->facts, array); v != JSON_NONE;
         v = ffd_json_tree_after(r->facts, v))
        if (is_kind(r, v, JSON_OBJECT) || is_kind(r, v, JSON_ARRAY))
            return true;
    return false;
}

/* Numbers are separated by spaces; names, which may contain spaces, by commas. */
static void write_value(renderer *r, uint32_t value)
{
    const uint32_t first = ffd_json_tree_first(r->facts, value);
    if (!is_kind(r, value, JSON_ARRAY) || first == JSON_NONE) {
        write_scalar(r, value);
        return;
    }
    for (uint32_t v = first; v != JSON_NONE; v = ffd_json_tree_after(r->facts, v)) {
        if (v != first)
            ffd_buffer_text(r->out, is_name(r, v) ? ", " : " ");
        if (is_kind(r, v, JSON_NULL))
            ffd_buffer_text(r->out, "(no name)");
        else
            write_scalar(r, v);
    }
}

static void write_spaces(byte_buffer *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        ffd_buffer_text(out, " ");
}

/* Writes "boundary_loops" as "boundary loops". */
static void write_name(byte_buffer *out, const char *name)
{
    for (const char *c = name; *c; c++)
        ffd_buffer_append(out, *c == '_' || (unsigned char)*c < 0x20 ? " " : c, 1);
}

/* Makes room in the column for a name of this width with its indent. */
static void make_room(renderer *r, size_t used)
{
    if (used <= WIDEST && used > r->width)
        r->width = used;
}

/* Ends the column after a name. */
static void write_gap(renderer *r, size_t used)
{
    write_spaces(r->out, (used < r->width ? r->width - used : 0) + GAP);
}

/* value JSON_NONE: write the name alone. */
static void render_line(renderer *r, size_t depth, const char *name, uint32_t value)
{
    const size_t used = INDENT * depth + text_width(name);
    if (!r->out) {
        if (value != JSON_NONE)
            make_room(r, used);
        return;
    }
    write_spaces(r->out, INDENT * depth);
    write_name(r->out, name);
    if (value != JSON_NONE) {
        write_gap(r, used);
        write_value(r, value);
    }
    ffd_buffer_text(r->out, "\n");
}

/* Writes the numbers of an array inside one of a thing's members, such as "min" of "bounds". */
static void write_corner(renderer *r, uint32_t bounds, const char *key)
{
    const uint32_t corner = ffd_json_tree_member(r->facts, bounds, key);
    if (corner != JSON_NONE)
        write_value(r, corner);
}

/* Writes "12 faces" for the member "faces". one: the word for a single one. */
static void write_count(renderer *r, uint32_t thing, const char *key, const char *one)
{
    double count = 0;
    ffd_json_tree_number(r->facts, ffd_json_tree_member(r->facts, thing, key), &count);
    ffd_buffer_format(r->out, "%.0f %s", count, ffd_plural((uint64_t)count, one, key));
}

/* Writes a thing's vertices, faces and bounds on one line, as a mesh may have thousands of things. */
static void write_drawing(renderer *r, uint32_t thing)
{
    const uint32_t bounds = ffd_json_tree_member(r->facts, thing, "bounds");
    write_count(r, thing, "vertices", "vertex");
    ffd_buffer_text(r->out, ", ");
    write_count(r, thing, "faces", "face");
    if (!is_kind(r, bounds, JSON_OBJECT))
        return;
    ffd_buffer_text(r->out, ", from ");
    write_corner(r, bounds, "min");
    ffd_buffer_text(r->out, " to ");
    write_corner(r, bounds, "max");
}

/* Returns the selector of a named thing, or the kind and number of an unnamed one. The caller frees it; NULL:
   out of memory. */
static char *thing_name(const renderer *r, uint32_t thing)
{
    const uint32_t selector = ffd_json_tree_member(r->facts, thing, "selector");
    if (selector != JSON_NONE)
        return ffd_json_tree_string(r->facts, selector, NULL);
    double number = 0;
    byte_buffer text = {0};
    char *const kind = ffd_json_tree_string(r->facts, ffd_json_tree_member(r->facts, thing, "kind"), NULL);
    ffd_json_tree_number(r->facts, ffd_json_tree_member(r->facts, thing, "number"), &number);
    ffd_buffer_format(&text, "%s %.0f", kind ? kind : "", number);
    char *const name = kind ? ffd_buffer_finish(&text) : NULL;
    ffd_free(kind);
    ffd_buffer_free(&text);
    return name;
}

/* Begins a line with a name of the file. Returns false in the first walk, in which nothing is written. */
static bool begin_named(renderer *r, size_t depth, const char *name)
{
    const size_t used = INDENT * depth + text_width(name);
    if (!r->out) {
        make_room(r, used);
        return false;
    }
    write_spaces(r->out, INDENT * depth);
    write_string(r->out, name);
    write_gap(r, used);
    return true;
}

/* A selector is written verbatim, so that it can be passed to --only. */
static void render_thing(renderer *r, size_t depth, uint32_t thing)
{
    char *const name = thing_name(r, thing);
    r->failed = r->failed || !name;
    if (name && begin_named(r, depth, name)) {
        write_drawing(r, thing);
        ffd_buffer_text(r->out, "\n");
    }
    ffd_free(name);
}

static void render_value(renderer *r, size_t depth, const char *name, uint32_t value);

/* Writes an animation by its name, with its length. */
static void render_animation(renderer *r, size_t depth, uint32_t animation)
{
    const uint32_t own = ffd_json_tree_member(r->facts, animation, "name");
    const uint32_t seconds = ffd_json_tree_member(r->facts, animation, "seconds");
    const bool has_name = is_kind(r, own, JSON_STRING);
    char *const name = has_name ? ffd_json_tree_string(r->facts, own, NULL) : NULL;
    r->failed = r->failed || (has_name && !name);
    if (begin_named(r, depth, name ? name : "(no name)")) {
        write_scalar(r, seconds);
        ffd_buffer_text(r->out, is_kind(r, seconds, JSON_NUMBER) ? " s\n" : "\n");
    }
    ffd_free(name);
}

/* Elements of an array are named by their index. */
static void render_elements(renderer *r, size_t depth, uint32_t array)
{
    size_t i = 0;
    for (uint32_t v = ffd_json_tree_first(r->facts, array); v != JSON_NONE;
         v = ffd_json_tree_after(r->facts, v)) {
        char number[32];
        snprintf(number, sizeof number, "%zu", i++);
        if (ffd_json_tree_member(r->facts, v, "faces") != JSON_NONE)
            render_thing(r, depth, v);
        else if (ffd_json_tree_member(r->facts, v, "seconds") != JSON_NONE)
            render_animation(r, depth, v);
        else
            render_value(r, depth, number, v);
    }
}

/* Whether a member is left out: the format of the JSON, and lists of names that are empty. */
static bool is_hidden(const renderer *r, size_t depth, uint32_t member)
{
    static const char *const keys[] = {"format", "version"};
    static const char *const lists[] = {"animations", "morph_targets", "joints", "cameras", "scenes"};
    if (depth > 0)
        return false;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (ffd_json_tree_key_is(r->facts, member, keys[i]))
            return true;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (ffd_json_tree_key_is(r->facts, member, lists[i]))
            return r->facts->values[member].count == 0;
    return false;
}

static void render_members(renderer *r, size_t depth, uint32_t object)
{
    for (uint32_t v = ffd_json_tree_first(r->facts, object); v != JSON_NONE;
         v = ffd_json_tree_after(r->facts, v)) {
        const bool hidden = is_hidden(r, depth, v);
        char *const key = hidden ? NULL : ffd_json_tree_key(r->facts, v);
        const bool was_exact = r->is_exact;
        r->is_exact = was_exact || (depth == 0 && key && strcmp(key, "parameters") == 0);
        if (key)
            render_value(r, depth, key, v);
        r->is_exact = was_exact;
        r->failed = r->failed || (!hidden && !key);
        ffd_free(key);
    }
}

/* The recursion is bounded by FFD_JSON_DEPTH, with which the JSON was written. */
static void render_value(renderer *r, size_t depth, const char *name, uint32_t value)
{
    const bool is_object = is_kind(r, value, JSON_OBJECT) && r->facts->values[value].count > 0;
    const bool is_list = is_kind(r, value, JSON_ARRAY) && has_inner_parts(r, value);
    render_line(r, depth, name, is_object || is_list ? JSON_NONE : value);
    if (is_object)
        render_members(r, depth + 1, value);
    else if (is_list)
        render_elements(r, depth + 1, value);
}

ffd_status ffd_info_render(const char *json, size_t size, char **text, ffd_error *error)
{
    const json_input input = {.text = json, .size = size, .name = ""};
    json_tree facts;
    TRY(ffd_json_parse(&input, &facts, error));
    byte_buffer out = {0};
    renderer r = {.facts = &facts};
    render_members(&r, 0, 0);
    r.out = &out;
    render_members(&r, 0, 0);
    ffd_json_tree_free(&facts);
    out.failed = out.failed || r.failed;
    *text = ffd_buffer_finish(&out);
    ffd_buffer_free(&out);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
