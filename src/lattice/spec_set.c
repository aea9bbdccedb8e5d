#include "lattice/spec_set.h"
#include "base/memory/memory.h"
#include "json/json_chars.h"
#include "json/json_parse.h"

/* The name, a string, in {"$": "NAME"}; JSON_NONE: it is not a placeholder. */
static uint32_t placeholder_name(const json_span *tree, uint32_t value)
{
    if (tree->values[value].kind != JSON_OBJECT || tree->values[value].count != 1)
        return JSON_NONE;
    const uint32_t name = ffd_json_span_member(tree, value, "$");
    return name != JSON_NONE && tree->values[name].kind == JSON_STRING ? name : JSON_NONE;
}

/* The value for the placeholder at the cursor. */
static ffd_status find_value(json_cursor cursor, uint32_t name, const spec_settings *settings,
                             spec_values *values, const json_span **tree)
{
    const json_value *const v = &cursor.tree->values[name];
    char shown[61];
    ffd_json_decode(cursor.tree->text + v->begin + 1, cursor.tree->text + v->end - 1, shown, sizeof shown);
    for (size_t i = 0; i < settings->count; i++) {
        if (!ffd_json_span_string_is(cursor.tree, name, settings->values[i].name))
            continue;
        json_setting *const value = &values->values[i];
        ffd_status status = FFD_OK;
        if (!value->tree.values)
            status = ffd_json_setting_parse(settings->values[i].value, JSON_NO_NUL | JSON_DOUBLES, value);
        settings->used[i] = true;
        *tree = &value->tree;
        if (status == FFD_E_INVALID)
            return ffd_cursor_fail(cursor, "the value of \"%s\" is neither JSON nor a text in UTF-8", shown);
        return status ? ffd_fail_memory(cursor.file->error) : FFD_OK;
    }
    return ffd_cursor_fail(cursor, "the placeholder \"%s\" has no value (--set %s=VALUE)", shown, shown);
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
        if (!status)
            status = add_substitute(file, v, value, values);
    }
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
    *values = (spec_values){0};
}
