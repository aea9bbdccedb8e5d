#include "lattice/file/spec_parameters.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "lattice/file/spec_values.h"
#include "json/json_parse.h"
#include <math.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* Reads an optional number. */
static ffd_status read_bound(json_cursor parameter, const char *key, double *bound)
{
    const json_cursor member = ffd_cursor_member(parameter, key);
    return ffd_cursor_exists(member) ? ffd_json_read_double(member, bound) : FFD_OK;
}

/* Reads an optional text; *text stays NULL if it is missing. */
static ffd_status read_text(json_cursor parameter, const char *key, char **text)
{
    const json_cursor member = ffd_cursor_member(parameter, key);
    if (!ffd_cursor_exists(member))
        return FFD_OK;
    if (!ffd_cursor_is(member, JSON_STRING))
        return ffd_cursor_fail(member, "must be a text, not %s", ffd_json_describe(member).text);
    *text = ffd_json_tree_string(member.tree, member.value, NULL);
    return *text ? FFD_OK : ffd_fail_memory(parameter.file->error);
}

/* Finds a number in a value, which may be in nested arrays, that is out of bounds. */
static bool find_outside(const json_tree *tree, uint32_t value, const spec_parameter *parameter,
                         double *number)
{
    for (uint32_t v = value; v < tree->values[value].next; v++)
        if (ffd_json_tree_number(tree, v, number) &&
            !(*number >= parameter->min && *number <= parameter->max))
            return true;
    return false;
}

static ffd_status fail_outside(json_cursor cursor, const spec_parameter *parameter, double number)
{
    const bool low = number < parameter->min;
    return ffd_cursor_fail(cursor, "%s is %s than the %s of \"%.60s\", %s%s%.60s",
                           ffd_number_text(number).text, low ? "less" : "greater", low ? "min" : "max",
                           parameter->name, ffd_number_text(low ? parameter->min : parameter->max).text,
                           parameter->unit && *parameter->unit ? " " : "",
                           parameter->unit ? parameter->unit : "");
}

ffd_status ffd_spec_check_bounds(json_cursor cursor, const spec_parameter *parameter, const json_tree *value)
{
    double number;
    return find_outside(value, 0, parameter, &number) ? fail_outside(cursor, parameter, number) : FFD_OK;
}

ffd_status ffd_spec_check_value(json_cursor value, const spec_parameter *parameter)
{
    double number;
    return find_outside(value.tree, value.value, parameter, &number) ? fail_outside(value, parameter, number)
                                                                     : FFD_OK;
}

static ffd_status read_default(json_cursor cursor, spec_parameter *parameter)
{
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    TRY(ffd_spec_check_value(cursor, parameter));
    parameter->value = ffd_json_tree_text(cursor.tree, cursor.value);
    return parameter->value ? FFD_OK : ffd_fail_memory(cursor.file->error);
}

static ffd_status read_name(json_cursor cursor, spec_parameter *parameter)
{
    parameter->name = ffd_json_tree_key(cursor.tree, cursor.value);
    if (!parameter->name)
        return ffd_fail_memory(cursor.file->error);
    if (parameter->name[0] == '-')
        return ffd_cursor_fail(cursor, "a name cannot begin with \"-\": {\"$\": \"-NAME\"} is NAME times -1");
    return *parameter->name ? FFD_OK : ffd_cursor_fail(cursor, "the name of a parameter is empty");
}

static ffd_status read_parameter(json_cursor cursor, spec_parameter *parameter)
{
    static const char *const keys[] = {"default", "min", "max", "unit", SPEC_NOTES};
    parameter->min = -INFINITY;
    parameter->max = INFINITY;
    TRY(read_name(cursor, parameter));
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(read_bound(cursor, "min", &parameter->min));
    TRY(read_bound(cursor, "max", &parameter->max));
    if (parameter->min > parameter->max)
        return ffd_cursor_fail(cursor, "min %s is greater than max %s", ffd_number_text(parameter->min).text,
                               ffd_number_text(parameter->max).text);
    TRY(read_text(cursor, "unit", &parameter->unit));
    TRY(read_text(cursor, "comment", &parameter->comment));
    return read_default(ffd_cursor_member(cursor, "default"), parameter);
}

ffd_status ffd_spec_parse_parameters(json_cursor cursor, lattice_spec *spec)
{
    if (!ffd_cursor_is(cursor, JSON_OBJECT))
        return ffd_cursor_fail(cursor, "must be an object of parameters, not %s",
                               ffd_json_describe(cursor).text);
    const size_t count = ffd_cursor_count(cursor);
    spec->parameters = ffd_alloc_zero(count, sizeof *spec->parameters);
    if (!spec->parameters)
        return ffd_fail_memory(cursor.file->error);
    spec->parameter_count = count;
    json_cursor parameter = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count; i++, parameter = ffd_cursor_next(parameter))
        TRY(read_parameter(parameter, &spec->parameters[i]));
    return FFD_OK;
}
