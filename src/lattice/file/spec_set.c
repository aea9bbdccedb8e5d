#include "lattice/file/spec_set.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "lattice/file/spec_parameters.h"
#include "lattice/file/spec_values.h"
#include "json/json_parse.h"
#include "json/json_text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A placeholder: {"$": "NAME"} or {"$": "-NAME"}, optionally with "times": NUMBER. */
typedef struct spec_placeholder {
    json_cursor at;
    char *name;
    double factor;
} spec_placeholder;

/* Returns the string value of "$"; JSON_NONE if the value is not a placeholder. A factor and notes are
   allowed as further members. */
static uint32_t placeholder_text(const json_tree *tree, uint32_t value)
{
    static const char *const others[] = {"times", SPEC_NOTES};
    if (tree->values[value].kind != JSON_OBJECT)
        return JSON_NONE;
    const uint32_t name = ffd_json_tree_member(tree, value, "$");
    if (name == JSON_NONE || tree->values[name].kind != JSON_STRING)
        return JSON_NONE;
    size_t known = 1;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        known += ffd_json_tree_member(tree, value, others[i]) != JSON_NONE;
    return tree->values[value].count == known ? name : JSON_NONE;
}

/* Reads the placeholder at the cursor. The caller frees its name, also after a failure. */
static ffd_status read_placeholder(json_cursor cursor, uint32_t text, spec_placeholder *placeholder)
{
    json_cursor times = cursor;
    times.value = ffd_json_tree_member(cursor.tree, cursor.value, "times");
    placeholder->at = cursor;
    placeholder->factor = 1;
    placeholder->name = ffd_json_tree_string(cursor.tree, text, NULL);
    if (!placeholder->name)
        return ffd_fail_memory(cursor.file->error);
    TRY(ffd_spec_check_notes(cursor));
    if (ffd_cursor_exists(times))
        TRY(ffd_json_read_double(times, &placeholder->factor));
    if (placeholder->name[0] == '-' && placeholder->name[1]) {
        memmove(placeholder->name, placeholder->name + 1, strlen(placeholder->name));
        placeholder->factor = -placeholder->factor;
    }
    return FFD_OK;
}

/* Makes hash tables of the names of settings and of those of parameters, which are distinct, for fast lookup
   in a file of any size. */
static ffd_status list_names(const json_file *file, const spec_settings *settings, const lattice_spec *spec,
                             spec_values *values)
{
    uint32_t index;
    values->settings = ffd_alloc(settings->count, sizeof *values->settings);
    if (!values->settings)
        return ffd_fail_memory(file->error);
    for (size_t i = 0; i < settings->count; i++) {
        const size_t known = values->set.count;
        if (!ffd_intern(&values->set, settings->values[i].name, strlen(settings->values[i].name), &index))
            return ffd_fail_memory(file->error);
        if (index == known)
            values->settings[index] = i;
    }
    for (size_t i = 0; i < spec->parameter_count; i++)
        if (!ffd_intern(&values->names, spec->parameters[i].name, strlen(spec->parameters[i].name), &index))
            return ffd_fail_memory(file->error);
    return FFD_OK;
}

/* Returns the parameter of a name; NULL if there is none. */
static const spec_parameter *find_parameter(const char *name, const lattice_spec *spec,
                                            const spec_values *values)
{
    uint32_t index;
    return ffd_intern_find(&values->names, name, strlen(name), &index) ? &spec->parameters[index] : NULL;
}

/* Returns the text of the value for a name, from a setting or else from the parameter's default; NULL if
   there is none. *number is its index in spec_values. */
static const char *find_text(const char *name, const spec_settings *settings, const lattice_spec *spec,
                             const spec_values *values, const spec_parameter *parameter, size_t *number)
{
    uint32_t known;
    if (ffd_intern_find(&values->set, name, strlen(name), &known)) {
        *number = values->settings[known];
        settings->used[*number] = true;
        return settings->values[*number].value;
    }
    if (!parameter || !parameter->value)
        return NULL;
    *number = settings->count + (size_t)(parameter - spec->parameters);
    return parameter->value;
}

/* Finds the value of a placeholder, without its factor; none if the placeholder is open. *is_keyed: it is one
   of a key. */
static ffd_status find_value(const spec_placeholder *placeholder, const spec_settings *settings,
                             const lattice_spec *spec, spec_values *values, const json_tree **tree,
                             bool *is_keyed)
{
    const spec_parameter *const parameter = find_parameter(placeholder->name, spec, values);
    size_t index;
    const char *const text = find_text(placeholder->name, settings, spec, values, parameter, &index);
    if (!text)
        return FFD_OK;
    *is_keyed = index < settings->count && index >= settings->count - settings->keyed;
    json_setting *const value = &values->values[index];
    ffd_status status = FFD_OK;
    if (!value->tree.values)
        status = ffd_json_setting_parse(text, JSON_NO_NUL | JSON_DOUBLES, value);
    *tree = &value->tree;
    if (status == FFD_E_INVALID)
        return ffd_cursor_fail(placeholder->at, "the value of \"%.60s\" is neither JSON nor a text in UTF-8",
                               placeholder->name);
    if (status)
        return ffd_fail_memory(placeholder->at.file->error);
    return parameter && !*is_keyed ? ffd_spec_check_bounds(placeholder->at, parameter, *tree) : FFD_OK;
}

/* Writes a number or an array of numbers, multiplied by the factor. Returns false if the value is neither. */
static bool write_product(byte_buffer *text, const json_tree *tree, double factor)
{
    const bool is_array = tree->values[0].kind == JSON_ARRAY;
    double number = 0;
    bool numbers = true;
    json_text json;
    ffd_json_begin(&json, text);
    if (is_array)
        ffd_json_array(&json, NULL, true);
    for (uint32_t v = is_array; v < tree->count && numbers; v++) {
        numbers = ffd_json_tree_number(tree, v, &number) && isfinite(factor * number);
        ffd_json_number(&json, NULL, factor * number);
    }
    if (is_array)
        ffd_json_end(&json, ']');
    return numbers;
}

/* Takes ownership of text. */
static ffd_status add_product(spec_values *values, char *text, const json_tree **tree)
{
    spec_product *const product = text ? ffd_alloc_zero(1, sizeof *product) : NULL;
    if (!product || !ffd_grow((void **)&values->products, &values->product_capacity,
                              values->product_count + 1, sizeof *values->products)) {
        ffd_free(product);
        ffd_free(text);
        return FFD_E_MEMORY;
    }
    values->products[values->product_count++] = product;
    product->text = text;
    *tree = &product->value.tree;
    return ffd_json_setting_parse(text, JSON_NO_NUL | JSON_DOUBLES, &product->value);
}

/* Replaces the value by its product with the factor of the placeholder. */
static ffd_status multiply(const spec_placeholder *placeholder, spec_values *values, const json_tree **tree)
{
    byte_buffer text = {0};
    if (write_product(&text, *tree, placeholder->factor))
        return add_product(values, ffd_buffer_finish(&text), tree)
                   ? ffd_fail_memory(placeholder->at.file->error)
                   : FFD_OK;
    ffd_buffer_free(&text);
    return ffd_cursor_fail(placeholder->at,
                           "the value of \"%.60s\" is to be multiplied: it must be a number or an array of "
                           "numbers, and the product finite",
                           placeholder->name);
}

/* Records the name of a placeholder without a value. */
static ffd_status note_open(const spec_placeholder *placeholder, intern_table *open)
{
    uint32_t index;
    return ffd_intern(open, placeholder->name, strlen(placeholder->name), &index)
               ? FFD_OK
               : ffd_fail_memory(placeholder->at.file->error);
}

/* The most bytes of names in a message. */
#define NAMES_SHOWN 300

void ffd_spec_describe_open(const intern_table *open, char *text, size_t capacity)
{
    char names[NAMES_SHOWN + 80] = "";
    const char *const first = ffd_intern_key(open, 0);
    size_t length = 0, shown = 0;
    if (open->count == 1) {
        snprintf(text, capacity, "the placeholder \"%.60s\" has no value (%s %.60s=VALUE)", first,
                 SPELLED("{set}"), first);
        return;
    }
    for (; shown < open->count && length < NAMES_SHOWN; shown++)
        length += (size_t)snprintf(names + length, sizeof names - length, "%s\"%.60s\"", shown ? ", " : "",
                                   ffd_intern_key(open, (uint32_t)shown));
    if (shown < open->count)
        snprintf(names + length, sizeof names - length, " and %zu more", open->count - shown);
    snprintf(text, capacity, "the placeholders %s have no values (%s NAME=VALUE for each)", names,
             SPELLED("{set}"));
}

/* Reports all open placeholders in one message, at the position of the first. */
static ffd_status refuse_open(const json_file *file, uint32_t value, const intern_table *open)
{
    char text[480];
    ffd_spec_describe_open(open, text, sizeof text);
    return ffd_cursor_fail((json_cursor){file, file->tree, value, JSON_NONE}, "%s", text);
}

static ffd_status add_substitute(const json_file *file, uint32_t value, const json_tree *tree,
                                 spec_values *values)
{
    if (!ffd_grow((void **)&values->substitutes, &values->substitute_capacity, values->substitute_count + 1,
                  sizeof *values->substitutes))
        return ffd_fail_memory(file->error);
    values->substitutes[values->substitute_count++] = (json_substitute){value, tree};
    return FFD_OK;
}

/* Substitutes the placeholder at value v of the file, or records that it is open. */
static ffd_status fill(json_file *file, uint32_t v, uint32_t text, const spec_settings *settings,
                       lattice_spec *spec, spec_values *values)
{
    spec_placeholder placeholder = {0};
    const json_tree *value = NULL;
    bool is_keyed = false;
    ffd_status status;
    TRY_END(read_placeholder((json_cursor){file, file->tree, v, JSON_NONE}, text, &placeholder));
    TRY_END(find_value(&placeholder, settings, spec, values, &value, &is_keyed));
    if (value && settings->derives && !is_keyed)
        TRY_END(ffd_spec_add_origin(file, (spec_origin){.value = v, .factor = placeholder.factor},
                                    placeholder.name, value, spec, &values->origins));
    if (value && placeholder.factor != 1)
        TRY_END(multiply(&placeholder, values, &value));
    TRY_END(value ? add_substitute(file, v, value, values) : note_open(&placeholder, &values->open));
end:
    ffd_free(placeholder.name);
    return status;
}

/* Substitutes the placeholders in one list. *first_open: the first one that is open; JSON_NONE: none yet. */
static ffd_status fill_list(json_file *file, uint32_t moves, const spec_settings *settings,
                            lattice_spec *spec, spec_values *values, uint32_t *first_open)
{
    const json_tree *const tree = file->tree;
    const uint32_t end = tree->values[moves].next;
    /* Descendants of "moves" follow it in the tree. */
    for (uint32_t v = moves + 1; v < end; v++) {
        const uint32_t text = placeholder_text(tree, v);
        if (text == JSON_NONE)
            continue;
        TRY(fill(file, v, text, settings, spec, values));
        if (*first_open == JSON_NONE && values->open.count > 0)
            *first_open = v;
    }
    return FFD_OK;
}

ffd_status ffd_spec_set(json_file *file, const uint32_t *moves, size_t count, const spec_settings *settings,
                        lattice_spec *spec, spec_values *values)
{
    uint32_t first_open = JSON_NONE;
    TRY(list_names(file, settings, spec, values));
    values->count = settings->count + spec->parameter_count;
    values->values = ffd_alloc_zero(values->count, sizeof *values->values);
    if (!values->values)
        return ffd_fail_memory(file->error);
    for (size_t i = 0; i < count; i++)
        TRY(fill_list(file, moves[i], settings, spec, values, &first_open));
    if (values->open.count > 0 && !settings->may_be_open)
        return refuse_open(file, first_open, &values->open);
    file->substitutes = values->substitutes;
    file->substitute_count = values->substitute_count;
    return FFD_OK;
}

void ffd_spec_values_free(spec_values *values)
{
    for (size_t i = 0; values->values && i < values->count; i++)
        ffd_json_setting_free(&values->values[i]);
    for (size_t i = 0; i < values->product_count; i++) {
        ffd_json_setting_free(&values->products[i]->value);
        ffd_free(values->products[i]->text);
        ffd_free(values->products[i]);
    }
    ffd_free(values->products);
    ffd_free(values->values);
    ffd_free(values->substitutes);
    ffd_free(values->origins.origins);
    ffd_intern_free(&values->open);
    ffd_intern_free(&values->names);
    ffd_intern_free(&values->set);
    ffd_free(values->settings);
    *values = (spec_values){0};
}
