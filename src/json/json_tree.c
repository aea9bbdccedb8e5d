#include "json/json_tree.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/number.h"
#include "json/json_chars.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int compare_members(const void *a, const void *b)
{
    const json_member *x = a, *y = b;
    return ffd_json_tree_compare_keys(x->tree, x->value, y->tree, y->value);
}

void ffd_json_tree_sort_keys(json_member *members, size_t count)
{
    if (count > 1)
        qsort(members, count, sizeof *members, compare_members);
}

void ffd_json_tree_sort(const json_tree *tree, uint32_t object, json_member *members)
{
    size_t count = 0;
    for (uint32_t v = ffd_json_tree_first(tree, object); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        members[count++] = (json_member){tree, v};
    ffd_json_tree_sort_keys(members, count);
}

void ffd_json_tree_free(json_tree *tree)
{
    ffd_free(tree->values);
    *tree = (json_tree){0};
}

uint32_t ffd_json_tree_first(const json_tree *tree, uint32_t container)
{
    return container != JSON_NONE && tree->values[container].count > 0 ? container + 1 : JSON_NONE;
}

uint32_t ffd_json_tree_after(const json_tree *tree, uint32_t value)
{
    const uint32_t next = tree->values[value].next, parent = tree->values[value].parent;
    return parent != JSON_NONE && next < tree->values[parent].next ? next : JSON_NONE;
}

uint32_t ffd_json_tree_member(const json_tree *tree, uint32_t object, const char *key)
{
    if (object == JSON_NONE || tree->values[object].kind != JSON_OBJECT)
        return JSON_NONE;
    const uint32_t end = tree->values[object].next;
    for (uint32_t v = object + 1; v < end; v = tree->values[v].next) {
        /* Most keys differ in the first character: an escape may stand for any. */
        const char first = tree->text[tree->values[v].key_begin + 1];
        if ((first == *key || first == '\\' || !*key) && ffd_json_tree_key_is(tree, v, key))
            return v;
    }
    return JSON_NONE;
}

uint32_t ffd_json_tree_element(const json_tree *tree, uint32_t array, size_t i)
{
    if (array == JSON_NONE || tree->values[array].kind != JSON_ARRAY)
        return JSON_NONE;
    uint32_t v = ffd_json_tree_first(tree, array);
    for (; v != JSON_NONE && i > 0; i--)
        v = ffd_json_tree_after(tree, v);
    return v;
}

bool ffd_json_tree_number(const json_tree *tree, uint32_t value, double *number)
{
    if (value == JSON_NONE || tree->values[value].kind != JSON_NUMBER)
        return false;
    return ffd_number_parse(tree->text + tree->values[value].begin, tree->text + tree->values[value].end,
                            number) != NULL;
}

#define NUL_SYMBOL "\xe2\x90\x80" /* U+2400 */

/* Replaces U+0000, at which a C string would end, by its symbol. There is room: the escape was longer. */
static void show_nuls(char *text, size_t length)
{
    const size_t symbol = sizeof NUL_SYMBOL - 1;
    size_t nuls = 0;
    for (size_t i = 0; i < length; i++)
        nuls += text[i] == 0;
    size_t to = length + nuls * (symbol - 1);
    text[to] = 0;
    for (size_t from = length; nuls > 0;) {
        const char c = text[--from];
        to -= c ? 1 : symbol;
        memcpy(text + to, c ? &c : NUL_SYMBOL, c ? 1 : symbol);
        nuls -= c == 0;
    }
}

/* Decodes the string whose quotes are at begin and end - 1. */
static char *decode(const json_tree *tree, uint32_t begin, uint32_t end, size_t *size)
{
    const size_t capacity = end - begin; /* an escape is never shorter than the UTF-8 it stands for */
    char *const text = ffd_alloc(capacity, 1);
    if (!text)
        return NULL;
    const size_t length = ffd_json_decode(tree->text + begin + 1, tree->text + end - 1, text, capacity);
    if (size)
        *size = length;
    else
        show_nuls(text, length);
    return text;
}

char *ffd_json_tree_string(const json_tree *tree, uint32_t value, size_t *size)
{
    return decode(tree, tree->values[value].begin, tree->values[value].end, size);
}

char *ffd_json_tree_key(const json_tree *tree, uint32_t value)
{
    return decode(tree, tree->values[value].key_begin, tree->values[value].key_end, NULL);
}

static bool spells(const json_tree *tree, uint32_t begin, uint32_t end, const char *text)
{
    const char *c = tree->text + begin + 1, *const last = tree->text + end - 1;
    const char *t = text, *const text_last = text + strlen(text);
    while (c < last && t < text_last) {
        uint32_t code = 0;
        char bytes[4];
        if (*c != '\\') { /* both are plain UTF-8 */
            if (*c++ != *t++)
                return false;
            continue;
        }
        c = ffd_json_parsed_char(c, last, &code);
        const size_t length = ffd_utf8_write(code, bytes);
        if ((size_t)(text_last - t) < length || memcmp(t, bytes, length) != 0)
            return false;
        t += length;
    }
    return c == last && t == text_last;
}

char *ffd_json_tree_text(const json_tree *tree, uint32_t value)
{
    const json_value *const part = &tree->values[value];
    const size_t size = part->end - part->begin;
    char *const text = ffd_alloc(size + 1, 1);
    if (text) {
        memcpy(text, tree->text + part->begin, size);
        text[size] = 0;
    }
    return text;
}

bool ffd_json_tree_key_is(const json_tree *tree, uint32_t value, const char *text)
{
    const json_value *v = &tree->values[value];
    return v->key_end > v->key_begin && spells(tree, v->key_begin, v->key_end, text);
}

bool ffd_json_tree_string_is(const json_tree *tree, uint32_t value, const char *text)
{
    const json_value *v = &tree->values[value];
    return v->kind == JSON_STRING && spells(tree, v->begin, v->end, text);
}

/* Compares by code points, which is also the order of the UTF-8 bytes. */
static int compare_text(const char *x, const char *x_last, const char *y, const char *y_last)
{
    while (x < x_last && y < y_last) {
        uint32_t a = 0, b = 0;
        x = ffd_json_parsed_char(x, x_last, &a);
        y = ffd_json_parsed_char(y, y_last, &b);
        if (a != b)
            return a < b ? -1 : 1;
    }
    return (x < x_last) - (y < y_last);
}

int ffd_json_tree_compare_keys(const json_tree *a, uint32_t x, const json_tree *b, uint32_t y)
{
    const json_value *v = &a->values[x], *w = &b->values[y];
    return compare_text(a->text + v->key_begin + 1, a->text + v->key_end - 1, b->text + w->key_begin + 1,
                        b->text + w->key_end - 1);
}

bool ffd_json_tree_equal_strings(const json_tree *a, uint32_t x, const json_tree *b, uint32_t y)
{
    const json_value *v = &a->values[x], *w = &b->values[y];
    return compare_text(a->text + v->begin + 1, a->text + v->end - 1, b->text + w->begin + 1,
                        b->text + w->end - 1) == 0;
}

/* Appends one step of a JSON pointer, "/nodes" or "/3", with '~' and '/' escaped as ~0 and ~1. What does not
   fit is omitted. Returns the new length. */
static size_t pointer_step(const json_tree *tree, uint32_t value, char *text, size_t length, size_t capacity)
{
    const json_value *v = &tree->values[value];
    if (v->key_end == v->key_begin) {
        size_t i = 0;
        for (uint32_t e = v->parent + 1; e != value; e = tree->values[e].next)
            i++;
        snprintf(text + length, capacity - length, "/%zu", i);
        return length + strlen(text + length);
    }
    text[length++] = '/';
    const char *c = tree->text + v->key_begin + 1, *const last = tree->text + v->key_end - 1;
    while (c < last) {
        uint32_t code = 0;
        char bytes[4] = "~0";
        c = ffd_json_parsed_char(c, last, &code);
        size_t size = 2;
        if (code == '/')
            bytes[1] = '1';
        else if (code != '~')
            size = ffd_utf8_write(code, bytes);
        if (length + size >= capacity)
            break;
        memcpy(text + length, bytes, size);
        length += size;
    }
    text[length] = 0;
    return length;
}

void ffd_json_tree_pointer(const json_tree *tree, uint32_t value, char *text, size_t capacity)
{
    uint32_t path[JSON_TREE_DEPTH + 1];
    size_t depth = 0, length = 0;
    for (uint32_t v = value; tree->values[v].parent != JSON_NONE; v = tree->values[v].parent)
        path[depth++] = v;
    text[0] = 0;
    while (depth > 0 && length + 2 < capacity)
        length = pointer_step(tree, path[--depth], text, length, capacity);
}

size_t ffd_json_tree_line_from(const json_tree *tree, uint32_t value, json_line_mark *mark)
{
    const char *const end = tree->text + tree->values[value].begin;
    if (!mark->at || end < mark->at)
        *mark = (json_line_mark){tree->whole, tree->line};
    size_t line = mark->line;
    for (const char *c = mark->at; line > 0 && c < end; c++)
        line += *c == '\n';
    *mark = (json_line_mark){end, line};
    return line;
}

size_t ffd_json_tree_line(const json_tree *tree, uint32_t value)
{
    json_line_mark mark = {0};
    return ffd_json_tree_line_from(tree, value, &mark);
}

ffd_status ffd_json_tree_fail(const json_tree *tree, uint32_t value, const char *name, ffd_status status,
                              ffd_error *error, const char *format, ...)
{
    if (!error)
        return status;
    char pointer[sizeof error->pointer], message[sizeof error->message];
    ffd_json_tree_pointer(tree, value, pointer, sizeof pointer);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, SPELLED(format), arguments);
    va_end(arguments);
    return ffd_fail_at(error, status, name, ffd_json_tree_line(tree, value), pointer, "%s", message);
}
