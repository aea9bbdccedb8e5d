/* info_lattice.c - describes a lattice file for `ffd info`. */
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/vector/vec.h"
#include "job/chain/lattice_memory.h"
#include "job/info.h"
#include "lattice/build.h"
#include "lattice/file/spec_parse.h"
#include "lattice/lattice.h"
#include "lattice/shape_border.h"
#include "mesh/bounds.h"
#include <ffd/embedding.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *knot_word(knot_kind kind)
{
    switch (kind) {
    case KNOTS_CLAMPED:
        return "clamped";
    case KNOTS_OPEN:
        return "open";
    case KNOTS_UNIFORM:
        return "uniform";
    case KNOTS_CLOSED:
        return "closed";
    case KNOTS_LIST:
        return "list";
    case KNOTS_CLOSED_LIST:
        return "closed list";
    }
    return NULL;
}

static const char *rest_word(const lattice_spec *spec)
{
    switch (spec->rest) {
    case SPEC_BOX:
        return "box";
    case SPEC_BOX_MESH:
        return spec->mesh_count ? "meshes" : "mesh";
    case SPEC_CYLINDER:
        return "cylinder";
    case SPEC_POINTS:
        return "points";
    }
    return NULL;
}

static void write_directions(const ffd_lattice *lattice, json_text *json)
{
    static const char *const direction[3] = {"u", "v", "w"};
    ffd_json_array(json, "size", true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, lattice->size[a]);
    ffd_json_end(json, ']');
    ffd_json_array(json, "degree", true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, (uint64_t)lattice->knots[a].degree);
    ffd_json_end(json, ']');
    ffd_json_array(json, "knots", true);
    for (int a = 0; a < 3; a++)
        ffd_json_string(json, NULL, knot_word(lattice->knots[a].kind));
    ffd_json_end(json, ']');
    ffd_json_object(json, "domain", false);
    for (int a = 0; a < 3; a++) {
        const double ends[2] = {ffd_knots_first(&lattice->knots[a]), ffd_knots_last(&lattice->knots[a])};
        ffd_json_vector(json, direction[a], ends, 2);
    }
    ffd_json_end(json, '}');
}

static ffd_bounds bounds_of(const double *points, size_t count)
{
    ffd_bounds bounds = ffd_bounds_empty();
    for (size_t i = 0; i < count; i++)
        ffd_bounds_widen(&bounds, points + 3 * i);
    return bounds;
}

static void write_nulls(const char *const *keys, size_t count, json_text *json)
{
    for (size_t i = 0; i < count; i++)
        ffd_json_null(json, keys[i]);
}

/* Writes the names of placeholders without a value, if there are any. */
static void write_open(const intern_table *open, json_text *json)
{
    if (open->count == 0)
        return;
    ffd_json_array(json, "open_placeholders", true);
    for (size_t i = 0; i < open->count; i++)
        ffd_json_string(json, NULL, ffd_intern_key(open, (uint32_t)i));
    ffd_json_end(json, ']');
}

/* Writes the parameters that the file describes, if there are any. */
static void write_parameters(const lattice_spec *spec, json_text *json)
{
    if (spec->parameter_count == 0)
        return;
    ffd_json_object(json, "parameters", false);
    for (size_t i = 0; i < spec->parameter_count; i++) {
        const spec_parameter *const parameter = &spec->parameters[i];
        ffd_json_object(json, parameter->name, false);
        if (parameter->value)
            ffd_json_raw(json, "default", parameter->value, strlen(parameter->value));
        if (parameter->min > -INFINITY)
            ffd_json_number(json, "min", parameter->min);
        if (parameter->max < INFINITY)
            ffd_json_number(json, "max", parameter->max);
        if (parameter->unit)
            ffd_json_string(json, "unit", parameter->unit);
        if (parameter->comment)
            ffd_json_string(json, "comment", parameter->comment);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
}

/* Writes how many keys there are, and from when to when, if there are any. */
static void write_keys(const lattice_spec *spec, json_text *json)
{
    const spec_keys *const keys = &spec->keys;
    if (keys->count == 0)
        return;
    ffd_json_object(json, "keys", false);
    ffd_json_string(json, "kind", keys->kind == KEYS_VALUES ? "set" : "points");
    ffd_json_count(json, "count", keys->count);
    ffd_json_number(json, "first", keys->list[0].time);
    ffd_json_number(json, "last", keys->list[keys->count - 1].time);
    ffd_json_end(json, '}');
}

static void write_moves(const ffd_lattice *lattice, json_text *json)
{
    static const char *const unknown[] = {"moved", "largest_move", "weights_moved"};
    size_t moved = 0;
    double largest = 0;
    if (lattice->spec->open.count > 0) {
        write_nulls(unknown, sizeof unknown / sizeof *unknown, json);
        return;
    }
    for (size_t i = 0; i < lattice->count; i++) {
        const double length = vec_length(lattice->difference + 3 * i);
        moved += lattice->moved[i] != 0;
        largest = length > largest ? length : largest;
    }
    ffd_json_count(json, "moved", moved);
    ffd_json_number(json, "largest_move", largest);
    ffd_json_bool(json, "weights_moved", lattice->weights_moved);
}

/* A lattice that cannot be inverted is still described. */
static ffd_status write_inversion(const ffd_lattice *lattice, json_text *json, ffd_error *error)
{
    ffd_locator *locator = NULL;
    ffd_error reason = {0};
    const ffd_status status = ffd_locator_create(lattice, &locator, &reason);
    if (!status)
        ffd_json_string(json, "inversion", ffd_locator_get_method(locator));
    ffd_locator_destroy(&locator);
    if (!status)
        return FFD_OK;
    if (status != FFD_E_INVALID && status != FFD_E_LIMIT) {
        if (error)
            *error = reason;
        return status;
    }
    ffd_json_null(json, "inversion");
    ffd_json_string(json, "inversion_unknown", reason.message);
    return FFD_OK;
}

static ffd_status write_volume(const ffd_lattice *lattice, json_text *json, ffd_error *error)
{
    const ffd_bounds rest = bounds_of(lattice->rest, lattice->count);
    const ffd_bounds deformed = bounds_of(lattice->deformed, lattice->count);
    ffd_info_bounds(json, "rest_bounds", &rest);
    if (lattice->spec->open.count > 0)
        ffd_json_null(json, "deformed_bounds");
    else
        ffd_info_bounds(json, "deformed_bounds", &deformed);
    ffd_json_number(json, "diagonal", lattice->diagonal);
    write_moves(lattice, json);
    return write_inversion(lattice, json, error);
}

static ffd_status check_values(const ffd_info_desc *desc, const bool *used, ffd_error *error)
{
    for (size_t i = 0; i < desc->set_count; i++)
        if (!used[i])
            return ffd_fail_file(error, FFD_E_INVALID, desc->file.path,
                                 "the lattice has no placeholder {\"$\": \"%.60s\"} ({set})",
                                 desc->set[i].name);
    return FFD_OK;
}

/* *fits: whether the control points are within the memory limit. If not, they are not made. */
static ffd_status build(lattice_spec *spec, memory_budget *budget, ffd_lattice **lattice, bool *fits,
                        ffd_error *error)
{
    memory_budget knots = *budget;
    const ffd_status too_large = ffd_lattice_memory_take(budget, spec, 0, error);
    *fits = !too_large;
    if (!too_large)
        return ffd_spec_build(spec, NULL, lattice, error);
    return ffd_budget_take(&knots, ffd_spec_knot_bytes(spec), 1, NULL)
               ? too_large
               : ffd_spec_build_knots(spec, lattice, error);
}

/* Loads the lattice with the values given. Each must have a placeholder; other placeholders may stay open. */
static ffd_status load(const ffd_info_desc *desc, ffd_lattice **lattice, bool *fits, ffd_error *error)
{
    bool *const used = ffd_alloc_zero(desc->set_count, sizeof *used);
    const spec_settings settings = {
        .values = desc->set, .used = used, .count = desc->set_count, .may_be_open = true};
    memory_budget budget = ffd_budget_make(desc->file.memory);
    const ffd_lattice_source source = {.path = desc->file.path, .text = desc->file.bytes};
    lattice_spec *spec = NULL;
    size_t size = 0;
    if (!used)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(ffd_spec_load(&source, &settings, &spec, &size, error));
    ffd_budget_add_file(&budget, size, 0);
    TRY_END(check_values(desc, used, error));
    TRY_END(build(spec, &budget, lattice, fits, error));
end:
    if (status)
        ffd_spec_free(spec);
    ffd_free(used);
    return status;
}

/* Writes what is known without control points. */
static void write_unbuilt(const ffd_lattice *lattice, bool fits, json_text *json)
{
    static const char *const unknown[] = {"rest_bounds",  "deformed_bounds", "diagonal", "moved",
                                          "largest_move", "weights_moved",   "inversion"};
    ffd_json_bool(json, "rational",
                  lattice->spec->weights || lattice->spec->deformed_weights ||
                      ffd_spec_has_exact(lattice->spec));
    write_nulls(unknown, sizeof unknown / sizeof *unknown, json);
    if (lattice->spec->open.count > 0)
        ffd_json_null(json, "moves");
    else
        ffd_json_count(json, "moves", lattice->spec->move_count);
    const bool comes = ffd_lattice_needs_bounds(lattice) && ffd_lattice_get_mesh_count(lattice) == 0;
    if (fits || comes) /* the rest depends on meshes that are not known */
        return;
    char reason[100];
    snprintf(reason, sizeof reason, "the control points need %.0f MB of memory (%s allows more)",
             ceil_of(1e-6 * (double)ffd_spec_point_bytes(lattice->spec)), SPELLED("{file.memory}"));
    ffd_json_string(json, "points_unknown", reason);
}

ffd_status ffd_info_lattice(const ffd_info_desc *desc, json_text *json, ffd_error *error)
{
    ffd_lattice *lattice = NULL;
    ffd_bounds box;
    bool fits = false;
    TRY(load(desc, &lattice, &fits, error));
    write_directions(lattice, json);
    ffd_json_count(json, "control_points", lattice->count);
    ffd_json_string(json, "rest", rest_word(lattice->spec));
    write_parameters(lattice->spec, json);
    write_open(&lattice->spec->open, json);
    write_keys(lattice->spec, json);
    ffd_status status;
    TRY_END(ffd_info_box(lattice, &desc->file, fits, &box, json, error));
    ffd_info_layers(lattice, &box, json);
    if (lattice->rest) {
        ffd_json_bool(json, "rational", lattice->rest_weights != NULL);
        if (ffd_lattice_off_shape(lattice) > 0)
            ffd_json_number(json, "border_off", ffd_lattice_off_shape(lattice));
        TRY_END(write_volume(lattice, json, error));
    } else {
        write_unbuilt(lattice, fits, json);
    }
end:
    ffd_lattice_destroy(&lattice);
    return status;
}
