#include "lattice/file/spec_set.h"
#include "base/memory/memory.h"
#include "lattice/file/spec_values.h"
#include "json/json_chars.h"
#include "json/json_parse.h"
#include <stdio.h>
#include <string.h>

/* The name, a string, in {"$": "NAME"}, beside which there may be notes; JSON_NONE: it is not a placeholder.
 */
static uint32_t placeholder_name(const json_span *tree, uint32_t value)
{
    static const char *const notes[] = {SPEC_NOTES};
    if (tree->values[value].kind != JSON_OBJECT)
        return JSON_NONE;
    const uint32_t name = ffd_json_span_member(tree, value, "$");
    if (name == JSON_NONE || tree->values[name].kind != JSON_STRING)
        return JSON_NONE;
    size_t known = 1;
    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++)
        known += ffd_json_span_member(tree, value, notes[i]) != JSON_NONE;
    return tree->values[value].count == known ? name : JSON_NONE;
}

/* The value for the placeholder at the cursor; none where it is open. */
static ffd_status find_value(json_cursor cursor, uint32_t name, const spec_settings *settings,
                             spec_values *values, const json_span **tree)
{
    const json_value *const v = &cursor.tree->values[name];
    char shown[61];
    const ffd_status notes = ffd_spec_check_notes(cursor);
    if (notes)
        return notes;
    for (size_t i = 0; i < settings->count; i++) {
        if (!ffd_json_span_string_is(cursor.tree, name, settings->values[i].name))
            continue;
        json_setting *const value = &values->values[i];
        ffd_status status = FFD_OK;
        if (!value->tree.values)
            status = ffd_json_setting_parse(settings->values[i].value, JSON_NO_NUL | JSON_DOUBLES, value);
        settings->used[i] = true;
        *tree = &value->tree;
        ffd_json_decode(cursor.tree->text + v->begin + 1, cursor.tree->text + v->end - 1, shown,
                        sizeof shown);
        if (status == FFD_E_INVALID)
            return ffd_cursor_fail(cursor, "the value of \"%s\" is neither JSON nor a text in UTF-8", shown);
        return status ? ffd_fail_memory(cursor.file->error) : FFD_OK;
    }
    return FFD_OK;
}

/* Notes the name of a placeholder without a value. */
static ffd_status note_open(const json_file *file, uint32_t name, intern_table *open)
{
    size_t size;
    uint32_t number;
    char *const text = ffd_json_span_string(file->tree, name, &size);
    const bool noted = text && ffd_intern(open, text, size, &number);
    ffd_free(text);
    return noted ? FFD_OK : ffd_fail_memory(file->error);
}

/* Bytes of names in a message. */
#define NAMES_SHOWN 300

void ffd_spec_describe_open(const intern_table *open, char *text, size_t capacity)
{
    char names[NAMES_SHOWN + 80] = "";
    const char *const first = ffd_intern_key(open, 0);
    size_t length = 0, shown = 0;
    if (open->count == 1) {
        snprintf(text, capacity, "the placeholder \"%.60s\" has no value (--set %.60s=VALUE)", first, first);
        return;
    }
    for (; shown < open->count && length < NAMES_SHOWN; shown++)
        length += (size_t)snprintf(names + length, sizeof names - length, "%s\"%.60s\"", shown ? ", " : "",
                                   ffd_intern_key(open, (uint32_t)shown));
    if (shown < open->count)
        snprintf(names + length, sizeof names - length, " and %zu more", open->count - shown);
    snprintf(text, capacity, "the placeholders %s have no values (--set NAME=VALUE for each)", names);
}

/* All of them at once, at the place of the first. */
static ffd_status refuse_open(const json_file *file, uint32_t value, const intern_table *open)
{
    char text[480];
    ffd_spec_describe_open(open, text, sizeof text);
    return ffd_cursor_fail((json_cursor){file, file->tree, value, JSON_NONE}, "%s", text);
}

static ffd_status add_substitute(const json_file *file, uint32_t value, const json_span *tree,
                                 spec_values *values)
{
    if (!ffd_grow((void **)&values->substitutes, &values->substitute_capacity, values->substitute_count + 1,
                  sizeof *values->substitutes))
        return ffd_fail_memory(file->error);
    values->substitutes[values->substitute_count++] = (json_substitute){value, tree};
    return FFD_OK;
}

ffd_status ffd_spec_set(json_file *file, uint32_t moves, const spec_settings *settings, spec_values *values)
{
    const json_span *const tree = file->tree;
    const uint32_t end = moves == JSON_NONE ? 0 : tree->values[moves].next;
    ffd_status status = FFD_OK;
    uint32_t first_open = JSON_NONE;
    values->count = settings->count;
    values->values = ffd_alloc_zero(settings->count, sizeof *values->values);
    if (!values->values)
        return ffd_fail_memory(file->error);
    /* All that is within moves follows it in the tree. */
    for (uint32_t v = moves + 1; v < end && !status; v++) {
        const uint32_t name = placeholder_name(tree, v);
        const json_span *value = NULL;
        if (name == JSON_NONE)
            continue;
        status = find_value((json_cursor){file, tree, v, JSON_NONE}, name, settings, values, &value);
        if (!status && value)
            status = add_substitute(file, v, value, values);
        if (status || value)
            continue;
        first_open = values->open.count > 0 ? first_open : v;
        status = note_open(file, name, &values->open);
    }
    if (!status && values->open.count > 0 && !settings->may_be_open)
        status = refuse_open(file, first_open, &values->open);
    file->substitutes = values->substitutes;
    file->substitute_count = values->substitute_count;
    return status;
}

void ffd_spec_values_free(spec_values *values)
{
    for (size_t i = 0; values->values && i < values->count; i++)
        ffd_json_setting_free(&values->values[i]);
    ffd_free(values->values);
    ffd_free(values->substitutes);
    ffd_intern_free(&values->open);
    *values = (spec_values){0};
}
