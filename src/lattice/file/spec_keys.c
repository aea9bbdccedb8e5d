#include "lattice/file/spec_keys.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/text/buffer.h"
#include "base/text/number.h"
#include "lattice/file/key_values.h"
#include "lattice/file/spec_parse_moves.h"
#include "lattice/file/spec_values.h"
#include "json/json_parse.h"
#include "json/json_setting.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* What a key may give. */
static const char *const gifts[] = {"offsets", "moves", "set"};

/* Finds the member of a key that tells its control points. */
static ffd_status find_gift(json_cursor key, json_cursor *gift)
{
    const char *found = NULL;
    for (size_t i = 0; i < COUNT_OF(gifts); i++) {
        const json_cursor member = ffd_cursor_member(key, gifts[i]);
        if (!ffd_cursor_exists(member))
            continue;
        if (found)
            return ffd_cursor_fail(key, "has both \"%s\" and \"%s\"; a key has one of them", found, gifts[i]);
        found = gifts[i];
        *gift = member;
    }
    return found ? FFD_OK
                 : ffd_cursor_fail(key, "gives no control points: a key has \"offsets\", \"moves\" or "
                                        "\"set\"");
}

/* Times are exact in a file of single precision too, as an animation is. */
static ffd_status read_time(json_cursor key, size_t k, lattice_spec *spec)
{
    double *const time = &spec->keys.list[k].time;
    json_cursor cursor;
    TRY(ffd_json_require(key, "time", &cursor));
    TRY(ffd_json_read_double(cursor, time));
    if (!(*time >= 0))
        return ffd_cursor_fail(cursor, "the time %s is less than 0", ffd_number_text(*time).text);
    if (!isfinite((float)*time))
        return ffd_cursor_fail(cursor, "the time %s is too large", ffd_number_text(*time).text);
    if (k == 0 || (float)*time > (float)spec->keys.list[k - 1].time)
        return FFD_OK;
    return ffd_cursor_fail(cursor, "the time %s is not after that of the key before, %s%s",
                           ffd_number_text(*time).text, ffd_number_text(spec->keys.list[k - 1].time).text,
                           *time > spec->keys.list[k - 1].time ? ": the two are the same in single precision"
                                                               : "");
}

static ffd_status read_key(json_cursor key, size_t k, lattice_spec *spec)
{
    static const char *const keys[] = {"time", "offsets", "moves", "set", SPEC_NOTES};
    json_cursor gift;
    TRY(ffd_spec_read_object(key, keys, COUNT_OF(keys)));
    TRY(read_time(key, k, spec));
    TRY(find_gift(key, &gift));
    const bool is_set = ffd_cursor_exists(ffd_cursor_member(key, "set"));
    const keys_kind kind = is_set ? KEYS_VALUES : KEYS_POINTS;
    if (k > 0 && kind != spec->keys.kind)
        return ffd_cursor_fail(gift,
                               "the keys before have %s, and a file has keys of one kind: all with \"set\", "
                               "or all with \"offsets\" or \"moves\"",
                               is_set ? "none with \"set\"" : "\"set\"");
    spec->keys.kind = kind;
    return is_set ? ffd_key_read_values(gift, k, spec) : FFD_OK;
}

/* A value that the keys give is chosen by the time. */
static ffd_status refuse_settings(json_cursor keys, const spec_settings *settings, const spec_keys *of)
{
    for (size_t i = 0; i < settings->count; i++)
        for (size_t n = 0; n < of->name_count; n++)
            if (strcmp(of->names[n], settings->values[i].name) == 0)
                return ffd_cursor_fail_as(keys, FFD_E_ARGUMENT,
                                          "%s cannot give \"%.60s\": the keys do (%s chooses)",
                                          SPELLED("{set}"), of->names[n], SPELLED("{time}"));
    return FFD_OK;
}

ffd_status ffd_spec_begin_keys(json_cursor keys, const spec_settings *settings, lattice_spec *spec)
{
    if (!ffd_cursor_exists(keys))
        return FFD_OK;
    if (!ffd_cursor_is(keys, JSON_ARRAY))
        return ffd_cursor_fail(keys, "must be an array of keys, not %s", ffd_json_describe(keys).text);
    const size_t count = ffd_cursor_count(keys);
    if (count < 2)
        return ffd_cursor_fail(keys, "has %zu %s, but needs at least 2", count, count == 1 ? "key" : "keys");
    spec->keys.list = ffd_alloc_zero(count, sizeof *spec->keys.list);
    if (!spec->keys.list)
        return ffd_fail_memory(keys.file->error);
    spec->keys.count = count;
    json_cursor key = ffd_cursor_first(keys);
    for (size_t k = 0; k < count; k++, key = ffd_cursor_next(key))
        TRY(read_key(key, k, spec));
    spec->keys.is_chosen = settings->time;
    spec->keys.time = settings->time ? *settings->time : spec->keys.list[0].time;
    return refuse_settings(keys, settings, &spec->keys);
}

ffd_status ffd_spec_add_keyed(const spec_keys *keys, const spec_settings *settings, keyed_settings *keyed,
                              ffd_error *error)
{
    const size_t own = settings->count, count = own + keys->name_count;
    *keyed = (keyed_settings){.settings = *settings};
    keyed->values = ffd_alloc(count, sizeof *keyed->values);
    keyed->used = ffd_alloc_zero(count, sizeof *keyed->used);
    keyed->texts = ffd_alloc_zero(keys->name_count, sizeof *keyed->texts);
    if (!keyed->values || !keyed->used || !keyed->texts)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < own; i++)
        keyed->values[i] = settings->values[i];
    for (; keyed->text_count < keys->name_count; keyed->text_count++) {
        char *const text = ffd_key_value(keys, keyed->text_count);
        if (!text)
            return ffd_fail_memory(error);
        keyed->texts[keyed->text_count] = text;
        keyed->values[own + keyed->text_count] = (ffd_setting){keys->names[keyed->text_count], text};
    }
    keyed->settings.values = keyed->values;
    keyed->settings.used = keyed->used;
    keyed->settings.count = count;
    keyed->settings.keyed = keys->name_count;
    return FFD_OK;
}

void ffd_spec_mark_used(const keyed_settings *keyed, const spec_settings *settings)
{
    for (size_t i = 0; i < settings->count; i++)
        settings->used[i] = settings->used[i] || keyed->used[i];
}

void ffd_keyed_settings_free(keyed_settings *keyed)
{
    for (size_t i = 0; i < keyed->text_count; i++)
        ffd_free(keyed->texts[i]);
    ffd_free(keyed->texts);
    ffd_free(keyed->values);
    ffd_free(keyed->used);
    *keyed = (keyed_settings){0};
}

ffd_status ffd_spec_list_moves(json_cursor root, uint32_t **lists, size_t *count)
{
    const json_tree *const tree = root.tree;
    const uint32_t moves = ffd_json_tree_member(tree, root.value, "moves");
    const uint32_t keys = ffd_json_tree_member(tree, root.value, "keys");
    const bool is_first = moves != JSON_NONE && moves < keys; /* JSON_NONE is the greatest number */
    *count = 0;
    *lists = ffd_alloc(ffd_json_tree_count(tree, keys) + 1, sizeof **lists);
    if (!*lists)
        return ffd_fail_memory(root.file->error);
    if (is_first)
        (*lists)[(*count)++] = moves;
    for (uint32_t k = ffd_json_tree_first(tree, keys); k != JSON_NONE; k = ffd_json_tree_after(tree, k)) {
        const uint32_t own = ffd_json_tree_member(tree, k, "moves");
        if (own != JSON_NONE)
            (*lists)[(*count)++] = own;
    }
    if (moves != JSON_NONE && !is_first)
        (*lists)[(*count)++] = moves;
    return FFD_OK;
}

/* What the file has beside keys that give control points would be ignored. */
static ffd_status refuse_beside(json_cursor root, const lattice_spec *spec)
{
    const json_cursor moves = ffd_cursor_member(root, "moves");
    bool all_offsets = true;
    for (size_t k = 0; k < spec->keys.count; k++)
        all_offsets = all_offsets && spec->keys.list[k].offsets;
    if (ffd_cursor_is(moves, JSON_ARRAY) && ffd_cursor_count(moves) > 0)
        return ffd_cursor_fail(moves,
                               "keys with \"offsets\" or \"moves\" stand in place of these moves; only "
                               "keys with \"set\" use them");
    if (!all_offsets || !(spec->deformed_points || spec->deformed_offsets))
        return FFD_OK;
    return ffd_cursor_fail(
        ffd_cursor_member(ffd_cursor_member(root, "deformed"), spec->deformed_points ? "points" : "offsets"),
        "the offsets of all keys stand in place of these");
}

/* Reads the moves of a key as those of a file. */
static ffd_status read_moves(json_cursor moves, size_t k, lattice_spec *spec)
{
    char pointer[40];
    lattice_spec own = *spec;
    spec_key *const key = &spec->keys.list[k];
    own.moves = NULL;
    own.drags = NULL;
    own.move_count = own.drag_count = 0;
    snprintf(pointer, sizeof pointer, "/keys/%zu/moves", k);
    const ffd_status status = ffd_spec_parse_moves(moves, pointer, &own);
    key->moves = own.moves;
    key->move_count = own.move_count;
    key->drags = own.drags;
    key->drag_count = own.drag_count;
    return status;
}

static ffd_status read_points(json_cursor root, bool with_moves, lattice_spec *spec)
{
    json_cursor key = ffd_cursor_first(ffd_cursor_member(root, "keys"));
    for (size_t k = 0; k < spec->keys.count; k++, key = ffd_cursor_next(key)) {
        const json_cursor offsets = ffd_cursor_member(key, "offsets");
        if (ffd_cursor_exists(offsets))
            TRY(ffd_spec_read_points(offsets, spec->count, &spec->keys.list[k].offsets));
        else if (with_moves)
            TRY(read_moves(ffd_cursor_member(key, "moves"), k, spec));
    }
    return refuse_beside(root, spec);
}

/* A value that no move has is a slip of the pen. */
static ffd_status check_names(json_cursor root, const keyed_settings *keyed, const lattice_spec *spec)
{
    const json_cursor set = ffd_cursor_member(ffd_cursor_first(ffd_cursor_member(root, "keys")), "set");
    const size_t first = keyed->settings.count - keyed->settings.keyed;
    for (size_t n = 0; n < spec->keys.name_count; n++)
        if (!keyed->used[first + n])
            return ffd_cursor_fail(ffd_cursor_member(set, spec->keys.names[n]),
                                   "the moves have no placeholder {\"$\": \"%.60s\"}", spec->keys.names[n]);
    return FFD_OK;
}

/* Keeps a value as JSON. */
static ffd_status keep_value(const char *name, const char *text, spec_keys *keys, ffd_error *error)
{
    json_setting value = {0};
    spec_value *const to = &keys->others[keys->other_count];
    ffd_status status = ffd_json_setting_parse(text, JSON_NO_NUL | JSON_DOUBLES, &value);
    if (!status) {
        *to = (spec_value){ffd_text_copy(name), ffd_json_tree_text(&value.tree, 0)};
        keys->other_count++;
        status = to->name && to->value ? FFD_OK : FFD_E_MEMORY;
    }
    ffd_json_setting_free(&value);
    return status == FFD_E_MEMORY ? ffd_fail_memory(error) : FFD_OK; /* others cannot be used anyway */
}

/* Keeps the defaults of the placeholders that the keys do not give. */
static ffd_status keep_defaults(spec_keys *keys, const lattice_spec *spec, ffd_error *error)
{
    intern_table keyed = {0};
    ffd_status status = FFD_OK;
    uint32_t index;
    bool whole = true;
    for (size_t n = 0; n < keys->name_count && whole; n++)
        whole = ffd_intern(&keyed, keys->names[n], strlen(keys->names[n]), &index);
    TRY_END(whole ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < spec->parameter_count; i++) { /* the first of a name counts */
        const spec_parameter *const parameter = &spec->parameters[i];
        if (parameter->value && !ffd_intern_find(&keyed, parameter->name, strlen(parameter->name), &index))
            TRY_END(keep_value(parameter->name, parameter->value, keys, error));
    }
end:
    ffd_intern_free(&keyed);
    return status;
}

/* Keeps what the moves need at other times. */
static ffd_status keep_moves(json_cursor moves, const keyed_settings *keyed, lattice_spec *spec)
{
    const spec_settings *const settings = &keyed->settings;
    const size_t own = settings->count - settings->keyed;
    spec_keys *const keys = &spec->keys;
    ffd_error *const error = moves.file->error;
    keys->moves = ffd_json_tree_text(moves.tree, moves.value);
    keys->moves_line = ffd_cursor_line(moves);
    keys->others = ffd_alloc(own + spec->parameter_count, sizeof *keys->others);
    if (!keys->moves || !keys->others)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < own; i++)
        TRY(keep_value(settings->values[i].name, settings->values[i].value, keys, error));
    return keep_defaults(keys, spec, error);
}

ffd_status ffd_spec_end_keys(json_cursor root, const keyed_settings *keyed, bool with_moves,
                             lattice_spec *spec)
{
    if (spec->keys.kind == KEYS_NONE)
        return FFD_OK;
    if (spec->keys.kind == KEYS_POINTS)
        return read_points(root, with_moves, spec);
    TRY(check_names(root, keyed, spec));
    return keep_moves(ffd_cursor_member(root, "moves"), keyed, spec);
}

/* Reads the moves from their text, with the values of the time. */
static ffd_status read_again(const json_tree *tree, const spec_settings *settings, lattice_spec *spec,
                             ffd_error *error)
{
    json_file file = {.name = spec->name, .tree = tree, .error = error};
    spec_values values = {0};
    const uint32_t moves = ffd_json_tree_member(tree, 0, "moves");
    ffd_status status;
    TRY_END(ffd_spec_set(&file, &moves, 1, settings, spec, &values));
    TRY_END(ffd_spec_parse_moves(ffd_cursor_member(ffd_cursor_top(&file), "moves"), "/moves", spec));
end:
    ffd_spec_values_free(&values);
    return status;
}

ffd_status ffd_spec_moves_at(lattice_spec *spec, ffd_error *error)
{
    static const char head[] = "{\"moves\":";
    const size_t count = spec->keys.other_count;
    ffd_setting *const others = ffd_alloc(count, sizeof *others);
    keyed_settings keyed = {0};
    byte_buffer text = {0};
    json_tree tree = {0};
    bool none = false;
    ffd_status status;
    spec->moves = NULL;
    spec->drags = NULL;
    spec->move_count = spec->drag_count = 0;
    TRY_END(others ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++)
        others[i] = (ffd_setting){spec->keys.others[i].name, spec->keys.others[i].value};
    TRY_END(ffd_spec_add_keyed(&spec->keys, &(spec_settings){.values = others, .used = &none, .count = count},
                               &keyed, error));
    ffd_buffer_text(&text, head);
    ffd_buffer_text(&text, spec->keys.moves);
    ffd_buffer_text(&text, "}");
    TRY_END(text.failed ? ffd_fail_memory(error) : FFD_OK);
    TRY_END(ffd_json_parse(&(json_input){.text = text.data,
                                         .size = text.size,
                                         .name = spec->name,
                                         .line = spec->keys.moves_line,
                                         .rules = JSON_NO_NUL | JSON_DOUBLES},
                           &tree, error));
    TRY_END(read_again(&tree, &keyed.settings, spec, error));
end:
    ffd_json_tree_free(&tree);
    ffd_buffer_free(&text);
    ffd_keyed_settings_free(&keyed);
    ffd_free(others);
    return status;
}
