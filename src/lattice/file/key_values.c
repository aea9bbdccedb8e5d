#include "lattice/file/key_values.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "lattice/file/spec_parameters.h"
#include "lattice/keys.h"
#include "json/json_parse.h"
#include "json/json_setting.h"
#include "json/json_text.h"
#include <string.h>

/* Checks that a value has nothing but numbers, and arrays of such. */
static ffd_status check_kinds(json_cursor value)
{
    const uint32_t end = value.tree->values[value.value].next;
    for (json_cursor v = value; v.value < end; v.value++)
        if (!ffd_cursor_is(v, JSON_NUMBER) && !ffd_cursor_is(v, JSON_ARRAY))
            return ffd_cursor_fail(v, "is %s: between keys go numbers and arrays of numbers",
                                   ffd_json_describe(v).text);
    return FFD_OK;
}

/* Returns whether two values are numbers, or arrays of equal shape: all parts follow each other in a tree. */
static bool same_shape(const json_tree *a, const json_tree *b, uint32_t value)
{
    const uint32_t count = a->values[0].next;
    if (b->values[value].next - value != count)
        return false;
    for (uint32_t v = 0; v < count; v++)
        if (a->values[v].kind != b->values[value + v].kind ||
            a->values[v].count != b->values[value + v].count)
            return false;
    return true;
}

static ffd_status check_shape(json_cursor value, const char *name, const char *first)
{
    json_setting before;
    if (ffd_json_setting_parse(first, JSON_NO_NUL | JSON_DOUBLES, &before))
        return ffd_fail_memory(value.file->error);
    const bool is_same = same_shape(&before.tree, value.tree, value.value);
    ffd_json_setting_free(&before);
    return is_same
               ? FFD_OK
               : ffd_cursor_fail(value, "\"%.60s\" has another shape in the first key, %.60s", name, first);
}

/* Adds a name to those of the keys. */
static ffd_status add_name(json_cursor value, spec_keys *keys)
{
    keys->names[keys->name_count] = ffd_json_tree_key(value.tree, value.value);
    if (!keys->names[keys->name_count])
        return ffd_fail_memory(value.file->error);
    keys->name_count++;
    return FFD_OK;
}

/* Tables of the names of keys and parameters, for files with many. */
typedef struct name_tables {
    intern_table keys, parameters;
} name_tables;

static bool list_names(const lattice_spec *spec, name_tables *tables)
{
    uint32_t index;
    bool whole = true;
    for (size_t i = 0; i < spec->keys.name_count && whole; i++)
        whole = ffd_intern(&tables->keys, spec->keys.names[i], strlen(spec->keys.names[i]), &index);
    for (size_t i = 0; i < spec->parameter_count && whole; i++)
        whole = ffd_intern(&tables->parameters, spec->parameters[i].name, strlen(spec->parameters[i].name),
                           &index);
    return whole;
}

/* Reads a value of a name, which is that of the value's key. */
static ffd_status read_value(json_cursor value, const char *name, size_t k, const name_tables *tables,
                             lattice_spec *spec)
{
    spec_key *const key = &spec->keys.list[k];
    uint32_t index, parameter;
    if (!ffd_intern_find(&tables->keys, name, strlen(name), &index))
        return ffd_cursor_fail(value, "the first key does not give \"%.60s\": all keys give the same", name);
    TRY(check_kinds(value));
    if (k > 0)
        TRY(check_shape(value, name, spec->keys.list[0].values[index]));
    if (ffd_intern_find(&tables->parameters, name, strlen(name), &parameter))
        TRY(ffd_spec_check_value(value, &spec->parameters[parameter]));
    key->values[index] = ffd_json_tree_text(value.tree, value.value);
    return key->values[index] ? FFD_OK : ffd_fail_memory(value.file->error);
}

static ffd_status read_values(json_cursor set, size_t k, const name_tables *tables, lattice_spec *spec)
{
    json_cursor value = ffd_cursor_first(set);
    for (; ffd_cursor_exists(value); value = ffd_cursor_next(value)) {
        char *const name = ffd_json_tree_key(value.tree, value.value);
        const ffd_status status =
            name ? read_value(value, name, k, tables, spec) : ffd_fail_memory(value.file->error);
        ffd_free(name);
        TRY(status);
    }
    for (size_t n = 0; n < spec->keys.name_count; n++)
        if (!spec->keys.list[k].values[n])
            return ffd_cursor_fail(set, "does not give \"%.60s\", as the first key does",
                                   spec->keys.names[n]);
    return FFD_OK;
}

/* The first key has the names. */
static ffd_status begin_names(json_cursor set, spec_keys *keys)
{
    keys->names = ffd_alloc_zero(ffd_cursor_count(set), sizeof *keys->names);
    if (!keys->names)
        return ffd_fail_memory(set.file->error);
    json_cursor value = ffd_cursor_first(set);
    for (; ffd_cursor_exists(value); value = ffd_cursor_next(value))
        TRY(add_name(value, keys));
    return FFD_OK;
}

ffd_status ffd_key_read_values(json_cursor set, size_t k, lattice_spec *spec)
{
    spec_key *const key = &spec->keys.list[k];
    name_tables tables = {0};
    ffd_status status;
    if (!ffd_cursor_is(set, JSON_OBJECT) || ffd_cursor_count(set) == 0)
        return ffd_cursor_fail(set, "must be an object with a value for each placeholder, not %s",
                               ffd_cursor_is(set, JSON_OBJECT) ? "an empty one"
                                                               : ffd_json_describe(set).text);
    if (k == 0)
        TRY(begin_names(set, &spec->keys));
    key->values = ffd_alloc_zero(spec->keys.name_count, sizeof *key->values);
    TRY_END(key->values && list_names(spec, &tables) ? FFD_OK : ffd_fail_memory(set.file->error));
    TRY_END(read_values(set, k, &tables, spec));
end:
    ffd_intern_free(&tables.keys);
    ffd_intern_free(&tables.parameters);
    return status;
}

/* Writes the value between two of equal shape. */
static void write_between(const json_tree *a, const json_tree *b, double part, byte_buffer *text)
{
    /* The brackets of a value are where they are in a; its numbers are replaced. */
    size_t at = a->values[0].begin;
    for (uint32_t v = 0; v < a->values[0].next; v++) {
        double from = 0, to = 0;
        if (!ffd_json_tree_number(a, v, &from) || !ffd_json_tree_number(b, v, &to))
            continue;
        ffd_buffer_append(text, a->text + at, a->values[v].begin - at);
        ffd_buffer_number(text, ffd_keys_mix(part, from, to));
        at = a->values[v].end;
    }
    ffd_buffer_append(text, a->text + at, a->values[0].end - at);
}

char *ffd_key_value(const spec_keys *keys, size_t name)
{
    const key_place place = ffd_keys_find(keys);
    const char *const from = keys->list[place.first].values[name];
    json_setting a = {0}, b = {0};
    byte_buffer text = {0};
    if (!(place.part > 0))
        return ffd_text_copy(from);
    const unsigned rules = JSON_NO_NUL | JSON_DOUBLES;
    if (ffd_json_setting_parse(from, rules, &a) ||
        ffd_json_setting_parse(keys->list[place.first + 1].values[name], rules, &b))
        text.failed = true;
    else
        write_between(&a.tree, &b.tree, place.part, &text);
    ffd_json_setting_free(&a);
    ffd_json_setting_free(&b);
    char *const value = ffd_buffer_finish(&text);
    ffd_buffer_free(&text);
    return value;
}
