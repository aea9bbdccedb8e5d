#include "json/json_span.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "json/json_chars.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST_TEXT ((size_t)INT32_MAX)

typedef struct scanner {
    json_span *tree;
    const char *name;
    const char *at, *last;
    ffd_error *error;
} scanner;

static ffd_status syntax(const scanner *s, const char *place, const char *what)
{
    size_t line = 1;
    for (const char *c = s->tree->text; c < place; c++)
        line += *c == '\n';
    char found[16] = "end of text";
    if (place < s->last && *place >= 0x20 && *place < 0x7f)
        snprintf(found, sizeof found, "'%c'", *place);
    else if (place < s->last)
        snprintf(found, sizeof found, "byte 0x%02x", (unsigned)(unsigned char)*place);
    return ffd_fail_line(s->error, FFD_E_INVALID, s->name, line, "JSON: %s, found %s", what, found);
}

static void skip_space(scanner *s)
{
    while (s->at < s->last && (*s->at == ' ' || *s->at == '\t' || *s->at == '\n' || *s->at == '\r'))
        s->at++;
}

static bool is_digit(const scanner *s, const char *c)
{
    return c < s->last && *c >= '0' && *c <= '9';
}

static ffd_status scan_string(scanner *s)
{
    if (s->at == s->last || *s->at != '"')
        return syntax(s, s->at, "a string is expected");
    const char *const opened = s->at;
    const char *c = ffd_json_pass_plain(opened + 1, s->last);
    while (c < s->last && *c != '"') {
        uint32_t code;
        const char *behind = ffd_json_char(c, s->last, &code);
        if (!behind)
            return syntax(s, c, "a string holds what is no UTF-8 character or escape");
        c = ffd_json_pass_plain(behind, s->last);
    }
    if (c == s->last)
        return syntax(s, opened, "a string is not ended");
    s->at = c + 1;
    return FFD_OK;
}

/* The grammar of RFC 8259, 6. */
static ffd_status scan_number(scanner *s)
{
    const char *c = s->at;
    if (*c == '-')
        c++;
    if (!is_digit(s, c))
        return syntax(s, c, "a digit is expected");
    if (*c == '0' && is_digit(s, c + 1))
        return syntax(s, c, "a number starts with a needless 0");
    while (is_digit(s, c))
        c++;
    if (c < s->last && *c == '.') {
        c++;
        if (!is_digit(s, c))
            return syntax(s, c, "a digit is expected");
        while (is_digit(s, c))
            c++;
    }
    if (c < s->last && (*c == 'e' || *c == 'E')) {
        c++;
        if (c < s->last && (*c == '+' || *c == '-'))
            c++;
        if (!is_digit(s, c))
            return syntax(s, c, "a digit is expected");
        while (is_digit(s, c))
            c++;
    }
    s->at = c;
    return FFD_OK;
}

static bool scan_word(scanner *s, const char *word)
{
    const size_t length = strlen(word);
    if ((size_t)(s->last - s->at) < length || memcmp(s->at, word, length) != 0)
        return false;
    s->at += length;
    return true;
}

static ffd_status scan_scalar(scanner *s, json_value *value)
{
    if (s->at == s->last)
        return syntax(s, s->at, "a value is expected");
    ffd_status status = FFD_OK;
    if (*s->at == '"') {
        value->kind = JSON_STRING;
        status = scan_string(s);
    } else if (*s->at == '-' || is_digit(s, s->at)) {
        value->kind = JSON_NUMBER;
        status = scan_number(s);
    } else if (scan_word(s, "true")) {
        value->kind = JSON_TRUE;
    } else if (scan_word(s, "false")) {
        value->kind = JSON_FALSE;
    } else if (scan_word(s, "null")) {
        value->kind = JSON_NULL;
    } else {
        return syntax(s, s->at, "a value is expected");
    }
    value->end = (uint32_t)(s->at - s->tree->text);
    return status;
}

static uint32_t place(const scanner *s)
{
    return (uint32_t)(s->at - s->tree->text);
}

/* Makes room for a value, the last member so far of parent. */
static json_value *add_value(scanner *s, uint32_t parent)
{
    json_span *tree = s->tree;
    if (!ffd_grow((void **)&tree->values, &tree->capacity, tree->count + 1, sizeof *tree->values)) {
        ffd_fail_memory(s->error);
        return NULL;
    }
    json_value *value = &tree->values[tree->count++];
    *value = (json_value){.parent = parent, .next = (uint32_t)tree->count};
    if (parent != JSON_NONE)
        tree->values[parent].count++;
    return value;
}

static ffd_status scan_key(scanner *s, json_value *value)
{
    value->key_begin = place(s);
    const ffd_status status = scan_string(s);
    if (status)
        return status;
    value->key_end = place(s);
    skip_space(s);
    if (s->at == s->last || *s->at != ':')
        return syntax(s, s->at, "':' is expected");
    s->at++;
    skip_space(s);
    return FFD_OK;
}

static int compare_members(const void *a, const void *b)
{
    const json_member *x = a, *y = b;
    return ffd_json_span_compare_keys(x->tree, x->value, y->tree, y->value);
}

void ffd_json_span_sort_keys(json_member *members, size_t count)
{
    if (count > 1)
        qsort(members, count, sizeof *members, compare_members);
}

void ffd_json_span_sort(const json_span *tree, uint32_t object, json_member *members)
{
    size_t count = 0;
    for (uint32_t v = ffd_json_span_first(tree, object); v != JSON_NONE; v = ffd_json_span_after(tree, v))
        members[count++] = (json_member){tree, v};
    ffd_json_span_sort_keys(members, count);
}

#define FEW_MEMBERS 64

/* Two readers may take different ones of two equal keys: what is checked must be what is used. */
static ffd_status refuse_equal_keys(const scanner *s, uint32_t object)
{
    const json_span *tree = s->tree;
    const size_t count = tree->values[object].count;
    json_member few[FEW_MEMBERS];
    json_member *members = few;
    if (count < 2)
        return FFD_OK;
    if (count > FEW_MEMBERS && !(members = ffd_alloc(count, sizeof *members)))
        return ffd_fail_memory(s->error);
    ffd_json_span_sort(tree, object, members);
    ffd_status status = FFD_OK;
    for (size_t i = 1; i < count && status == FFD_OK; i++)
        if (compare_members(&members[i - 1], &members[i]) == 0)
            status = ffd_json_span_fail(tree, members[i].value, s->name, FFD_E_INVALID, s->error,
                                        "the key stands twice in its object");
    if (members != few)
        ffd_free(members);
    return status;
}

static ffd_status close_container(scanner *s, uint32_t *container)
{
    json_span *tree = s->tree;
    const uint32_t closed = *container;
    s->at++;
    tree->values[closed].end = place(s);
    tree->values[closed].next = (uint32_t)tree->count;
    *container = tree->values[closed].parent;
    return tree->values[closed].kind == JSON_OBJECT ? refuse_equal_keys(s, closed) : FFD_OK;
}

/* Reads a value of container; a container becomes the current one. */
static ffd_status scan_value(scanner *s, uint32_t *container, int *depth)
{
    json_span *tree = s->tree;
    json_value *value = add_value(s, *container);
    if (!value)
        return FFD_E_MEMORY;
    if (*container != JSON_NONE && tree->values[*container].kind == JSON_OBJECT) {
        const ffd_status status = scan_key(s, value);
        if (status)
            return status;
    }
    value->begin = place(s);
    if (s->at == s->last || (*s->at != '{' && *s->at != '['))
        return scan_scalar(s, value);
    if (++*depth > JSON_SPAN_DEPTH)
        return syntax(s, s->at, "values are nested more than 256 deep");
    value->kind = *s->at == '{' ? JSON_OBJECT : JSON_ARRAY;
    *container = (uint32_t)(tree->count - 1);
    s->at++;
    return FFD_OK;
}

/* One step inside a container: its end, or the next member with the comma before it. */
static ffd_status scan_member(scanner *s, uint32_t *container, int *depth)
{
    const json_value *in = &s->tree->values[*container];
    const bool object = in->kind == JSON_OBJECT;
    if (s->at < s->last && *s->at == (object ? '}' : ']')) {
        --*depth;
        return close_container(s, container);
    }
    if (in->count > 0) {
        if (s->at == s->last || *s->at != ',')
            return syntax(s, s->at, object ? "',' or '}' is expected" : "',' or ']' is expected");
        s->at++;
        skip_space(s);
    }
    return scan_value(s, container, depth);
}

static ffd_status scan_text(scanner *s)
{
    if (s->last - s->at >= 3 && memcmp(s->at, "\xef\xbb\xbf", 3) == 0)
        s->at += 3;
    skip_space(s);
    uint32_t container = JSON_NONE;
    int depth = 0;
    ffd_status status = scan_value(s, &container, &depth);
    while (status == FFD_OK && container != JSON_NONE) {
        skip_space(s);
        status = scan_member(s, &container, &depth);
    }
    if (status)
        return status;
    skip_space(s);
    return s->at < s->last ? syntax(s, s->at, "the text goes on behind its value") : FFD_OK;
}

ffd_status ffd_json_span_parse(const char *text, size_t size, const char *name, json_span *tree,
                               ffd_error *error)
{
    *tree = (json_span){.text = text, .size = size};
    if (size > LARGEST_TEXT)
        return ffd_fail_file(error, FFD_E_LIMIT, name, "its JSON has %zu bytes, more than 2147483647", size);
    scanner s = {.tree = tree, .name = name, .at = text, .last = text + size, .error = error};
    const ffd_status status = scan_text(&s);
    if (status)
        ffd_json_span_free(tree);
    return status;
}

void ffd_json_span_free(json_span *tree)
{
    ffd_free(tree->values);
    *tree = (json_span){0};
}

uint32_t ffd_json_span_first(const json_span *tree, uint32_t container)
{
    return container != JSON_NONE && tree->values[container].count > 0 ? container + 1 : JSON_NONE;
}

uint32_t ffd_json_span_after(const json_span *tree, uint32_t value)
{
    const uint32_t next = tree->values[value].next, parent = tree->values[value].parent;
    return parent != JSON_NONE && next < tree->values[parent].next ? next : JSON_NONE;
}

uint32_t ffd_json_span_member(const json_span *tree, uint32_t object, const char *key)
{
    if (object == JSON_NONE || tree->values[object].kind != JSON_OBJECT)
        return JSON_NONE;
    for (uint32_t v = ffd_json_span_first(tree, object); v != JSON_NONE; v = ffd_json_span_after(tree, v))
        if (ffd_json_span_key_is(tree, v, key))
            return v;
    return JSON_NONE;
}

uint32_t ffd_json_span_element(const json_span *tree, uint32_t array, size_t i)
{
    if (array == JSON_NONE || tree->values[array].kind != JSON_ARRAY)
        return JSON_NONE;
    uint32_t v = ffd_json_span_first(tree, array);
    for (; v != JSON_NONE && i > 0; i--)
        v = ffd_json_span_after(tree, v);
    return v;
}

bool ffd_json_span_number(const json_span *tree, uint32_t value, double *number)
{
    if (value == JSON_NONE || tree->values[value].kind != JSON_NUMBER)
        return false;
    return ffd_number_parse(tree->text + tree->values[value].begin, tree->text + tree->values[value].end,
                            number) != NULL;
}

/* The characters between the quotes at begin and end. */
static char *decode(const json_span *tree, uint32_t begin, uint32_t end, size_t *size)
{
    char *text = ffd_alloc(end - begin, 1); /* an escape is never shorter than its character */
    if (!text)
        return NULL;
    size_t length = 0;
    const char *c = tree->text + begin + 1, *const last = tree->text + end - 1;
    while (c < last) {
        const char *const plain = ffd_json_pass_plain(c, last);
        memcpy(text + length, c, (size_t)(plain - c));
        length += (size_t)(plain - c);
        c = plain;
        if (c < last) {
            uint32_t code = 0;
            c = ffd_json_char(c, last, &code);
            length += ffd_utf8_write(code, text + length);
        }
    }
    text[length] = 0;
    if (size)
        *size = length;
    return text;
}

char *ffd_json_span_string(const json_span *tree, uint32_t value, size_t *size)
{
    return decode(tree, tree->values[value].begin, tree->values[value].end, size);
}

char *ffd_json_span_key(const json_span *tree, uint32_t value)
{
    return decode(tree, tree->values[value].key_begin, tree->values[value].key_end, NULL);
}

static bool spells(const json_span *tree, uint32_t begin, uint32_t end, const char *text)
{
    const char *c = tree->text + begin + 1, *const last = tree->text + end - 1;
    const char *t = text, *const text_last = text + strlen(text);
    while (c < last && t < text_last) {
        uint32_t code = 0;
        char bytes[4];
        c = ffd_json_char(c, last, &code);
        const size_t length = ffd_utf8_write(code, bytes);
        if ((size_t)(text_last - t) < length || memcmp(t, bytes, length) != 0)
            return false;
        t += length;
    }
    return c == last && t == text_last;
}

bool ffd_json_span_key_is(const json_span *tree, uint32_t value, const char *text)
{
    const json_value *v = &tree->values[value];
    return v->key_end > v->key_begin && spells(tree, v->key_begin, v->key_end, text);
}

bool ffd_json_span_string_is(const json_span *tree, uint32_t value, const char *text)
{
    const json_value *v = &tree->values[value];
    return v->kind == JSON_STRING && spells(tree, v->begin, v->end, text);
}

/* By character, which is the order of their UTF-8 bytes too. */
static int compare_text(const char *x, const char *x_last, const char *y, const char *y_last)
{
    while (x < x_last && y < y_last) {
        uint32_t a = 0, b = 0;
        x = ffd_json_char(x, x_last, &a);
        y = ffd_json_char(y, y_last, &b);
        if (a != b)
            return a < b ? -1 : 1;
    }
    return (x < x_last) - (y < y_last);
}

int ffd_json_span_compare_keys(const json_span *a, uint32_t x, const json_span *b, uint32_t y)
{
    const json_value *v = &a->values[x], *w = &b->values[y];
    return compare_text(a->text + v->key_begin + 1, a->text + v->key_end - 1, b->text + w->key_begin + 1,
                        b->text + w->key_end - 1);
}

bool ffd_json_span_equal_strings(const json_span *a, uint32_t x, const json_span *b, uint32_t y)
{
    const json_value *v = &a->values[x], *w = &b->values[y];
    return compare_text(a->text + v->begin + 1, a->text + v->end - 1, b->text + w->begin + 1,
                        b->text + w->end - 1) == 0;
}

/* One step of a pointer, "/nodes" or "/3"; '~' and '/' are written ~0 and ~1. */
static void pointer_step(const json_span *tree, uint32_t value, char *text, size_t capacity)
{
    const json_value *v = &tree->values[value];
    if (v->key_end == v->key_begin) {
        size_t i = 0;
        for (uint32_t e = v->parent + 1; e != value; e = tree->values[e].next)
            i++;
        snprintf(text, capacity, "/%zu", i);
        return;
    }
    size_t length = 0;
    text[length++] = '/';
    const char *c = tree->text + v->key_begin + 1, *const last = tree->text + v->key_end - 1;
    while (c < last && length + 5 < capacity) {
        uint32_t code = 0;
        c = ffd_json_char(c, last, &code);
        if (code == '~' || code == '/') {
            text[length++] = '~';
            text[length++] = code == '~' ? '0' : '1';
        } else {
            length += ffd_utf8_write(code, text + length);
        }
    }
    text[length] = 0;
}

void ffd_json_span_pointer(const json_span *tree, uint32_t value, char *text, size_t capacity)
{
    uint32_t path[JSON_SPAN_DEPTH + 1];
    size_t depth = 0, length = 0;
    for (uint32_t v = value; tree->values[v].parent != JSON_NONE; v = tree->values[v].parent)
        path[depth++] = v;
    text[0] = 0;
    while (depth > 0 && length + 1 < capacity) {
        char step[128];
        pointer_step(tree, path[--depth], step, sizeof step);
        snprintf(text + length, capacity - length, "%s", step);
        length += strlen(text + length);
    }
}

ffd_status ffd_json_span_fail(const json_span *tree, uint32_t value, const char *name, ffd_status status,
                              ffd_error *error, const char *format, ...)
{
    if (!error)
        return status;
    char pointer[sizeof error->pointer], message[sizeof error->message];
    ffd_json_span_pointer(tree, value, pointer, sizeof pointer);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ffd_fail_at(error, status, name, pointer, "%s", message);
}
