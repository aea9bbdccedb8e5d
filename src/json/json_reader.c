#include "json/json_reader.h"
#include "base/arithmetic.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "json/json_chars.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool is_substitute(json_cursor cursor)
{
    return cursor.tree != cursor.file->tree;
}

static bool is_of_value_before(const void *substitute, const void *value)
{
    return ((const json_substitute *)substitute)->value < *(const uint32_t *)value;
}

/* Returns the substitute of a value if it has one, else the value. */
static json_cursor resolve(json_cursor cursor)
{
    const json_file *const file = cursor.file;
    if (cursor.value == JSON_NONE || is_substitute(cursor))
        return cursor;
    const size_t at = lower_bound(&cursor.value, file->substitutes, file->substitute_count,
                                  sizeof *file->substitutes, is_of_value_before);
    if (at < file->substitute_count && file->substitutes[at].value == cursor.value)
        return (json_cursor){file, file->substitutes[at].tree, 0, cursor.value};
    return cursor;
}

static json_cursor move_to(json_cursor cursor, uint32_t value)
{
    cursor.value = value;
    return resolve(cursor);
}

json_cursor ffd_cursor_top(const json_file *file)
{
    return resolve((json_cursor){file, file->tree, 0, JSON_NONE});
}

json_cursor ffd_cursor_member(json_cursor object, const char *key)
{
    return move_to(object, ffd_json_tree_member(object.tree, object.value, key));
}

json_cursor ffd_cursor_first(json_cursor container)
{
    return move_to(container, ffd_json_tree_first(container.tree, container.value));
}

json_cursor ffd_cursor_next(json_cursor element)
{
    /* The root of a substitute is followed by what follows the replaced value. */
    if (is_substitute(element) && element.value == 0)
        element = (json_cursor){element.file, element.file->tree, element.replaced, JSON_NONE};
    return move_to(element, ffd_json_tree_after(element.tree, element.value));
}

/* The JSON pointer of the value, cut to capacity. */
static void write_pointer(json_cursor cursor, char *text, size_t capacity)
{
    size_t length = 0;
    if (is_substitute(cursor)) {
        ffd_json_tree_pointer(cursor.file->tree, cursor.replaced, text, capacity);
        length = strlen(text);
    }
    ffd_json_tree_pointer(cursor.tree, cursor.value, text + length, capacity - length);
}

size_t ffd_cursor_line_from(json_cursor cursor, json_line_mark *mark)
{
    return ffd_json_tree_line_from(cursor.file->tree, is_substitute(cursor) ? cursor.replaced : cursor.value,
                                   mark);
}

size_t ffd_cursor_line(json_cursor cursor)
{
    json_line_mark mark = {0};
    return ffd_cursor_line_from(cursor, &mark);
}

static ffd_status fail(json_cursor cursor, ffd_status status, const char *format, va_list arguments)
{
    ffd_error *const error = cursor.file->error;
    if (!error)
        return status;
    char pointer[sizeof error->pointer], message[sizeof error->message];
    write_pointer(cursor, pointer, sizeof pointer);
    vsnprintf(message, sizeof message, format, arguments);
    return ffd_fail_at(error, status, cursor.file->name, ffd_cursor_line(cursor), pointer, "%s", message);
}

ffd_status ffd_cursor_fail(json_cursor cursor, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fail(cursor, FFD_E_INVALID, format, arguments);
    va_end(arguments);
    return FFD_E_INVALID;
}

ffd_status ffd_cursor_fail_as(json_cursor cursor, ffd_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fail(cursor, status, format, arguments);
    va_end(arguments);
    return status;
}

/* Reads the text of a string value, truncated to capacity. */
static void read_text(json_cursor cursor, char *text, size_t capacity)
{
    const json_value *const v = &cursor.tree->values[cursor.value];
    ffd_json_decode(cursor.tree->text + v->begin + 1, cursor.tree->text + v->end - 1, text, capacity);
}

/* Reads the key of a value, truncated to capacity. */
static void read_key(json_cursor cursor, char *text, size_t capacity)
{
    const json_value *const v = &cursor.tree->values[cursor.value];
    ffd_json_decode(cursor.tree->text + v->key_begin + 1, cursor.tree->text + v->key_end - 1, text, capacity);
}

json_words ffd_json_describe(json_cursor cursor)
{
    json_words words = {""};
    char text[61];
    double number;
    switch ((json_kind)cursor.tree->values[cursor.value].kind) {
    case JSON_OBJECT:
        snprintf(words.text, sizeof words.text, "an object");
        break;
    case JSON_ARRAY:
        snprintf(words.text, sizeof words.text, "an array of %zu", ffd_cursor_count(cursor));
        break;
    case JSON_STRING:
        read_text(cursor, text, sizeof text);
        snprintf(words.text, sizeof words.text, "the text \"%s\"", text);
        break;
    case JSON_NUMBER:
        ffd_json_tree_number(cursor.tree, cursor.value, &number);
        snprintf(words.text, sizeof words.text, "the number %s", ffd_number_text(number).text);
        break;
    case JSON_TRUE:
        snprintf(words.text, sizeof words.text, "true");
        break;
    case JSON_FALSE:
        snprintf(words.text, sizeof words.text, "false");
        break;
    case JSON_NULL:
        snprintf(words.text, sizeof words.text, "null");
        break;
    }
    return words;
}

static bool is_known(json_cursor member, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (ffd_json_tree_key_is(member.tree, member.value, known[i]))
            return true;
    return false;
}

/* Reads the members without resolving substitutes, because only the keys matter here. */
ffd_status ffd_json_read_object(json_cursor cursor, const char *const *known, size_t count)
{
    if (!ffd_cursor_is(cursor, JSON_OBJECT))
        return ffd_cursor_fail(cursor, "must be an object, not %s", ffd_json_describe(cursor).text);
    json_cursor member = cursor;
    for (member.value = ffd_json_tree_first(cursor.tree, cursor.value); ffd_cursor_exists(member);
         member.value = ffd_json_tree_after(member.tree, member.value)) {
        char key[81], hint[300];
        if (is_known(member, known, count))
            continue;
        read_key(member, key, sizeof key);
        ffd_words_hint(key, known, count, hint, sizeof hint);
        return ffd_cursor_fail(member, "unknown key \"%s\"; %s", key, hint);
    }
    return FFD_OK;
}

ffd_status ffd_json_read_array(json_cursor cursor, size_t count, const char *what)
{
    if (!ffd_cursor_is(cursor, JSON_ARRAY) || ffd_cursor_count(cursor) != count)
        return ffd_cursor_fail(cursor, "must be an array of %zu %s, not %s", count, what,
                               ffd_json_describe(cursor).text);
    return FFD_OK;
}

static ffd_status trace_number(json_cursor cursor, double *number)
{
    json_trace *const trace = cursor.file->trace;
    if (!ffd_grow((void **)&trace->entries, &trace->capacity, trace->count + 1, sizeof *trace->entries))
        return ffd_fail_memory(cursor.file->error);
    trace->entries[trace->count++] = (json_trace_entry){number, cursor.replaced, cursor.value};
    return FFD_OK;
}

ffd_status ffd_json_read_double(json_cursor cursor, double *number)
{
    if (!ffd_json_tree_number(cursor.tree, cursor.value, number))
        return ffd_cursor_fail(cursor, "must be a number, not %s", ffd_json_describe(cursor).text);
    return cursor.file->trace && is_substitute(cursor) ? trace_number(cursor, number) : FFD_OK;
}

ffd_status ffd_json_read_integer(json_cursor cursor, double *number)
{
    if (ffd_json_tree_number(cursor.tree, cursor.value, number) && *number == floor_of(*number) &&
        fabs(*number) <= 0x1p53)
        return FFD_OK;
    return ffd_cursor_fail(cursor, "must be a whole number, not %s", ffd_json_describe(cursor).text);
}

ffd_status ffd_json_read_doubles(json_cursor cursor, size_t count, double *numbers)
{
    TRY(ffd_json_read_array(cursor, count, "numbers"));
    json_cursor element = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count; i++, element = ffd_cursor_next(element))
        TRY(ffd_json_read_double(element, &numbers[i]));
    return FFD_OK;
}

ffd_status ffd_json_read_word(json_cursor cursor, const char *const *words, size_t count, size_t *index)
{
    for (*index = 0; *index < count; ++*index)
        if (ffd_json_tree_string_is(cursor.tree, cursor.value, words[*index]))
            return FFD_OK;
    if (!ffd_cursor_is(cursor, JSON_STRING))
        return ffd_cursor_fail(cursor, "must be a word like \"%s\", not %s", words[0],
                               ffd_json_describe(cursor).text);
    char text[81], hint[300];
    read_text(cursor, text, sizeof text);
    ffd_words_hint(text, words, count, hint, sizeof hint);
    return ffd_cursor_fail(cursor, "unknown word \"%s\"; %s", text, hint);
}

ffd_status ffd_json_require(json_cursor object, const char *key, json_cursor *member)
{
    *member = ffd_cursor_member(object, key);
    return ffd_cursor_exists(*member) ? FFD_OK : ffd_cursor_fail(object, "\"%s\" is missing", key);
}

ffd_status ffd_json_member_double(json_cursor object, const char *key, double *number)
{
    json_cursor member;
    TRY(ffd_json_require(object, key, &member));
    return ffd_json_read_double(member, number);
}

ffd_status ffd_json_member_doubles(json_cursor object, const char *key, size_t count, double *numbers)
{
    json_cursor member;
    TRY(ffd_json_require(object, key, &member));
    return ffd_json_read_doubles(member, count, numbers);
}
