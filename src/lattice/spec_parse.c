#include "lattice/spec_parse.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "lattice/direction.h"
#include "lattice/lattice.h"
#include "lattice/spec_set.h"
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

static const char *const top_keys[] = {"format", "version", "size",     "degree", "knots",
                                       "rest",   "weights", "deformed", "units",  "moves"};

ffd_status ffd_spec_parse_points(json_place *place, const json_t *value, size_t count, double **points)
{
    ffd_status status = ffd_json_read_array(place, value, count, "points");
    if (status)
        return status;
    *points = ffd_alloc(count, 3 * sizeof **points);
    if (!*points)
        return ffd_fail_memory(place->error);
    for (size_t i = 0; i < count && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        status = ffd_json_read_doubles(place, json_array_get(value, i), 3, *points + 3 * i);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_axis(json_place *place, const json_t *value, double axis[3])
{
    static const char *const names[] = {"x", "y", "z"};
    if (json_is_string(value)) {
        size_t index;
        const ffd_status status = ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
        for (size_t c = 0; c < 3; c++)
            axis[c] = c == index;
        return status;
    }
    const ffd_status status = ffd_json_read_doubles(place, value, 3, axis);
    if (status)
        return status;
    return ffd_direction_unit(axis) ? FFD_OK : ffd_place_fail(place, "is 0 0 0, which is no direction");
}

ffd_status ffd_spec_parse_axis(json_place *place, const json_t *object, const char *key, double axis[3])
{
    const json_t *value;
    ffd_status status = ffd_json_require(place, object, key, &value);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, key);
    status = read_axis(place, value, axis);
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_format(json_place *place, const json_t *root)
{
    static const char *const names[] = {SPEC_FORMAT};
    const json_t *value;
    size_t index;
    ffd_status status = ffd_json_require(place, root, "format", &value);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, "format");
    status = ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
    ffd_place_leave(place, before);
    return status;
}

/* Before the keys are judged: a newer version may have more of them. */
static ffd_status read_version(json_place *place, const json_t *root)
{
    const json_t *value;
    double version;
    ffd_status status = ffd_json_require(place, root, "version", &value);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, "version");
    status = ffd_json_read_integer(place, value, &version);
    if (!status && version > SPEC_VERSION)
        status = ffd_fail_at(place->error, FFD_E_UNSUPPORTED, place->file, place->pointer,
                             "version %.0f is newer than %d, the newest known here", version, SPEC_VERSION);
    else if (!status && version < SPEC_VERSION)
        status = ffd_place_fail(place, "there is no version %.0f, only %d", version, SPEC_VERSION);
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_size(json_place *place, const json_t *value, lattice_spec *spec)
{
    ffd_status status = ffd_json_read_array(place, value, 3, "sizes");
    spec->count = 1;
    for (size_t a = 0; a < 3 && !status; a++) {
        const size_t before = ffd_place_enter_index(place, a);
        double size;
        status = ffd_json_read_integer(place, json_array_get(value, a), &size);
        if (!status && size < 2)
            status = ffd_place_fail(place, "is %.0f, but a direction has at least 2 control points", size);
        /* count <= limit and size >= 2: dividing needs no wider numbers. */
        else if (!status && size > (double)(FFD_MAX_CONTROL_POINTS / spec->count))
            status =
                ffd_fail_at(place->error, FFD_E_LIMIT, place->file, place->pointer,
                            "size %.0f makes more than %zu control points", size, FFD_MAX_CONTROL_POINTS);
        if (!status) {
            spec->size[a] = (size_t)size;
            spec->count *= spec->size[a];
        }
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_degree(json_place *place, const json_t *value, lattice_spec *spec)
{
    ffd_status status = value ? ffd_json_read_array(place, value, 3, "degrees") : FFD_OK;
    for (size_t a = 0; a < 3 && !status; a++) {
        spec->degree[a] = spec->size[a] > 3 ? 3 : (int)spec->size[a] - 1;
        if (!value)
            continue;
        const size_t before = ffd_place_enter_index(place, a);
        double degree;
        status = ffd_json_read_integer(place, json_array_get(value, a), &degree);
        if (!status && (degree < 1 || degree > MAX_DEGREE))
            status = ffd_place_fail(place, "degree %.0f is not between 1 and %d", degree, MAX_DEGREE);
        else if (!status && degree > (double)(spec->size[a] - 1))
            status = ffd_place_fail(place, "degree %.0f needs at least %.0f control points, not %zu", degree,
                                    degree + 1, spec->size[a]);
        if (!status)
            spec->degree[a] = (int)degree;
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_knot_list(json_place *place, const json_t *value, size_t count, const char *what,
                                 lattice_spec *spec, size_t a)
{
    ffd_status status = ffd_json_read_array(place, value, count, what);
    if (status)
        return status;
    spec->list_count[a] = count;
    spec->list[a] = ffd_alloc(count, sizeof *spec->list[a]);
    if (!spec->list[a])
        return ffd_fail_memory(place->error);
    return ffd_json_read_doubles(place, value, count, spec->list[a]);
}

static ffd_status read_closed_list(json_place *place, const json_t *value, lattice_spec *spec, size_t a)
{
    static const char *const keys[] = {"closed"};
    const json_t *list;
    spec->kind[a] = KNOTS_CLOSED_LIST;
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_json_require(place, value, "closed", &list);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, "closed");
    status = read_knot_list(place, list, spec->size[a] + 1, "breakpoints", spec, a);
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_direction_knots(json_place *place, const json_t *value, lattice_spec *spec, size_t a)
{
    static const char *const names[] = {"clamped", "open", "uniform", "closed", "unclamped", "periodic"};
    static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM,
                                      KNOTS_CLOSED,  KNOTS_OPEN, KNOTS_CLOSED};
    if (json_is_array(value)) {
        spec->kind[a] = KNOTS_LIST;
        return read_knot_list(place, value, spec->size[a] + (size_t)spec->degree[a] + 1, "knots", spec, a);
    }
    if (json_is_object(value))
        return read_closed_list(place, value, spec, a);
    size_t index;
    const ffd_status status = ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
    if (!status)
        spec->kind[a] = kinds[index];
    return status;
}

/* A closed direction needs rest points that go round. */
static ffd_status check_closed(const json_place *place, const lattice_spec *spec, size_t a)
{
    if (spec->kind[a] != KNOTS_CLOSED && spec->kind[a] != KNOTS_CLOSED_LIST)
        return FFD_OK;
    if (spec->rest == SPEC_BOX || spec->rest == SPEC_BOX_MESH)
        return ffd_place_fail(place, "direction %c of a box cannot be closed: its points do not go round",
                              "uvw"[a]);
    if (spec->rest == SPEC_CYLINDER && a != 1)
        return ffd_place_fail(place, "direction %c of a cylinder cannot be closed, only v can", "uvw"[a]);
    if (spec->rest == SPEC_CYLINDER && !ffd_spec_full_turn(spec))
        return ffd_place_fail(place, "a cylinder from %s to %s degrees cannot be closed: it is no full turn",
                              ffd_number_text(spec->angle[0]).text, ffd_number_text(spec->angle[1]).text);
    return FFD_OK;
}

static ffd_status read_knots(json_place *place, const json_t *value, lattice_spec *spec)
{
    if (!value) {
        if (spec->rest == SPEC_CYLINDER && ffd_spec_full_turn(spec))
            spec->kind[1] = KNOTS_CLOSED;
        return FFD_OK;
    }
    ffd_status status = ffd_json_read_array(place, value, 3, "knot vectors");
    for (size_t a = 0; a < 3 && !status; a++) {
        const size_t before = ffd_place_enter_index(place, a);
        status = read_direction_knots(place, json_array_get(value, a), spec, a);
        if (!status)
            status = check_closed(place, spec, a);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_weights(json_place *place, const json_t *value, size_t count, double **weights)
{
    ffd_status status = ffd_json_read_array(place, value, count, "weights");
    if (status)
        return status;
    *weights = ffd_alloc(count, sizeof **weights);
    if (!*weights)
        return ffd_fail_memory(place->error);
    for (size_t i = 0; i < count && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        status = ffd_json_read_double(place, json_array_get(value, i), *weights + i);
        if (!status && !((*weights)[i] > 0))
            status = ffd_place_fail(place, "weight %s is not positive", ffd_number_text((*weights)[i]).text);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_deformed(json_place *place, const json_t *value, lattice_spec *spec)
{
    static const char *const keys[] = {"points", "weights"};
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    const json_t *const points = json_object_get(value, "points");
    const json_t *const weights = json_object_get(value, "weights");
    if (!status && points) {
        const size_t before = ffd_place_enter(place, "points");
        status = ffd_spec_parse_points(place, points, spec->count, &spec->deformed_points);
        ffd_place_leave(place, before);
    }
    if (!status && weights) {
        const size_t before = ffd_place_enter(place, "weights");
        status = read_weights(place, weights, spec->count, &spec->deformed_weights);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_units(json_place *place, const json_t *value, lattice_spec *spec)
{
    static const char *const names[] = {"world", "box"};
    size_t index;
    const ffd_status status = ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
    spec->box_units = index == 1;
    return status;
}

static ffd_status parse_weights(json_place *place, const json_t *value, lattice_spec *spec)
{
    return read_weights(place, value, spec->count, &spec->weights);
}

/* The members in the order in which they need each other. Only size and rest must be there; the readers of
   degree and knots supply what a missing value means. */
static ffd_status read_members(json_place *place, const json_t *root, lattice_spec *spec)
{
    static const struct member {
        const char *key;
        ffd_status (*read)(json_place *place, const json_t *value, lattice_spec *spec);
        bool required, has_default;
    } members[] = {
        {"size", read_size, true, false},           {"degree", read_degree, false, true},
        {"rest", ffd_spec_parse_rest, true, false}, {"knots", read_knots, false, true},
        {"weights", parse_weights, false, false},   {"deformed", read_deformed, false, false},
        {"units", read_units, false, false},        {"moves", ffd_spec_parse_moves, false, false},
    };
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < COUNT_OF(members) && !status; i++) {
        const struct member *const member = &members[i];
        const json_t *const value = json_object_get(root, member->key);
        if (!value && member->required)
            return ffd_place_fail(place, "\"%s\" is missing", member->key);
        if (!value && !member->has_default)
            continue;
        const size_t before = ffd_place_enter(place, member->key);
        status = member->read(place, value, spec);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_root(json_place *place, const json_t *root, lattice_spec *spec)
{
    if (!json_is_object(root))
        return ffd_place_fail(place, "a lattice is an object, not %s", ffd_json_describe(root).text);
    ffd_status status = read_format(place, root);
    if (!status)
        status = read_version(place, root);
    if (!status)
        status = ffd_json_read_object(place, root, top_keys, COUNT_OF(top_keys));
    if (!status)
        status = read_members(place, root, spec);
    return status;
}

/* What jansson says of a failed allocation: mostly nothing, and where it was reading a text, that the syntax
   is wrong. So memory is asked for once more. */
static bool is_out_of_memory(const json_error_t *problem, size_t size)
{
    json_t *const value = json_object();
    void *const block = ffd_alloc(size, sizeof *value);
    const bool missing = !value || !block;
    json_decref(value);
    ffd_free(block);
    return missing || !problem->text[0] || json_error_code(problem) == json_error_out_of_memory;
}

/* The parsed text, or NULL. All numbers are read as double: whole ones of any size are numbers too. A byte
   order mark is let pass (editors write it; RFC 8259, 8.1 allows that). The depth is limited by jansson
   itself (2048). */
static json_t *load_json(const char *text, size_t size, const char *name, ffd_error *error,
                         ffd_status *status)
{
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        text += 3;
        size -= 3;
    }
    json_error_t problem;
    json_t *const root =
        json_loadb(size ? text : "", size, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &problem);
    *status = FFD_OK;
    if (root)
        return root;
    if (is_out_of_memory(&problem, size))
        *status = ffd_fail_memory(error);
    else
        *status = ffd_fail_line(error, FFD_E_INVALID, name, problem.line > 0 ? (size_t)problem.line : 1,
                                "not valid JSON: %s", problem.text);
    return NULL;
}

/* Placeholders stand in moves only. */
static ffd_status fill_placeholders(json_place *place, json_t *root, const spec_settings *settings)
{
    static const spec_settings none = {NULL, NULL, 0};
    const size_t before = ffd_place_enter(place, "moves");
    const ffd_status status =
        ffd_spec_set(place, json_object_get(root, "moves"), settings ? settings : &none);
    ffd_place_leave(place, before);
    return status;
}

ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                          lattice_spec **spec, ffd_error *error)
{
    ffd_status status;
    *spec = NULL;
    json_t *const root = load_json(text, size, name, error, &status);
    lattice_spec *result = NULL;
    if (!root)
        goto out;
    result = ffd_alloc_zero(1, sizeof *result);
    if (!result || !(result->name = ffd_text_copy(name))) {
        status = ffd_fail_memory(error);
        goto out;
    }
    json_place place = {.file = name, .error = error};
    status = fill_placeholders(&place, root, settings);
    if (!status)
        status = read_root(&place, root, result);
    if (!status) {
        *spec = result;
        result = NULL;
    }
out:
    if (status)
        ffd_fail_name_file(error, name);
    ffd_spec_free(result);
    json_decref(root);
    return status;
}

void ffd_spec_free(lattice_spec *spec)
{
    if (!spec)
        return;
    ffd_free(spec->name);
    for (int a = 0; a < 3; a++)
        ffd_free(spec->list[a]);
    ffd_free(spec->points);
    ffd_free(spec->weights);
    ffd_free(spec->deformed_points);
    ffd_free(spec->deformed_weights);
    ffd_free(spec->moves);
    ffd_free(spec);
}
