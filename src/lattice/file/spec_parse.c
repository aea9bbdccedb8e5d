#include "lattice/file/spec_parse.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/content.h"
#include "base/text/number.h"
#include "lattice/file/spec_keys.h"
#include "lattice/file/spec_parameters.h"
#include "lattice/file/spec_parse_moves.h"
#include "lattice/file/spec_parse_rest.h"
#include "lattice/file/spec_values.h"
#include "lattice/lattice.h"
#include "json/json_parse.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

static const char *const top_keys[] = {"format",     "version", "size",     "degree", "knots",
                                       "rest",       "weights", "deformed", "units",  "moves",
                                       "parameters", "keys",    SPEC_NOTES};

static ffd_status read_format(json_cursor root)
{
    static const char *const names[] = {SPEC_FORMAT};
    json_cursor cursor;
    size_t index;
    TRY(ffd_json_require(root, "format", &cursor));
    return ffd_json_read_word(cursor, names, COUNT_OF(names), &index);
}

static ffd_status read_version(json_cursor root)
{
    json_cursor cursor;
    double version;
    TRY(ffd_json_require(root, "version", &cursor));
    TRY(ffd_json_read_integer(cursor, &version));
    if (version > SPEC_VERSION)
        return ffd_cursor_fail_as(cursor, FFD_E_UNSUPPORTED,
                                  "version %.0f is newer than %d, the newest known here", version,
                                  SPEC_VERSION);
    if (version < SPEC_VERSION)
        return ffd_cursor_fail(cursor, "version %.0f does not exist; the only version is %d", version,
                               SPEC_VERSION);
    return FFD_OK;
}

/* Reads the size of a direction; spec->count is the product of the sizes before it. */
static ffd_status read_direction_size(json_cursor cursor, lattice_spec *spec, size_t a)
{
    double size;
    TRY(ffd_json_read_integer(cursor, &size));
    if (size < 2)
        return ffd_cursor_fail(cursor, "is %.0f, but a direction has at least 2 control points%s", size,
                               size < 1 ? ""
                                        : ": a plane needs two layers that move alike: \"size\": [5, 5, 2], "
                                          "\"degree\": [3, 3, 1], and \"at\": [i, j, \"all\"]");
    /* Because count <= the limit, dividing the limit avoids an overflow. */
    if (size > (double)(FFD_MAX_CONTROL_POINTS / spec->count))
        return ffd_cursor_fail_as(cursor, FFD_E_LIMIT, "size %.0f makes more than %zu control points", size,
                                  FFD_MAX_CONTROL_POINTS);
    spec->size[a] = (size_t)size;
    spec->count *= spec->size[a];
    return FFD_OK;
}

static ffd_status read_size(json_cursor cursor, lattice_spec *spec)
{
    TRY(ffd_json_read_array(cursor, 3, "sizes"));
    json_cursor size = ffd_cursor_first(cursor);
    spec->count = 1;
    for (size_t a = 0; a < 3; a++, size = ffd_cursor_next(size))
        TRY(read_direction_size(size, spec, a));
    return FFD_OK;
}

static ffd_status read_direction_degree(json_cursor cursor, lattice_spec *spec, size_t a)
{
    double degree;
    TRY(ffd_json_read_integer(cursor, &degree));
    if (degree < 1 || degree > MAX_DEGREE)
        return ffd_cursor_fail(cursor, "degree %.0f is not between 1 and %d%s", degree, MAX_DEGREE,
                               ffd_degree_hint(degree));
    if (degree > (double)(spec->size[a] - 1))
        return ffd_cursor_fail(cursor, "degree %.0f needs at least %.0f control points, not %zu", degree,
                               degree + 1, spec->size[a]);
    spec->degree[a] = (int)degree;
    return FFD_OK;
}

static ffd_status read_degree(json_cursor cursor, lattice_spec *spec)
{
    for (size_t a = 0; a < 3; a++)
        spec->degree[a] = spec->size[a] > 3 ? 3 : (int)spec->size[a] - 1;
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    TRY(ffd_json_read_array(cursor, 3, "degrees"));
    json_cursor degree = ffd_cursor_first(cursor);
    for (size_t a = 0; a < 3; a++, degree = ffd_cursor_next(degree))
        TRY(read_direction_degree(degree, spec, a));
    return FFD_OK;
}

static ffd_status read_knot_list(json_cursor cursor, size_t count, const char *what, lattice_spec *spec,
                                 size_t a)
{
    TRY(ffd_json_read_array(cursor, count, what));
    spec->list_count[a] = count;
    spec->list[a] = ffd_alloc(count, sizeof *spec->list[a]);
    if (!spec->list[a])
        return ffd_fail_memory(cursor.file->error);
    return ffd_json_read_doubles(cursor, count, spec->list[a]);
}

static ffd_status read_closed_list(json_cursor cursor, lattice_spec *spec, size_t a)
{
    static const char *const keys[] = {"closed", SPEC_NOTES};
    json_cursor list;
    spec->kind[a] = KNOTS_CLOSED_LIST;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_json_require(cursor, "closed", &list));
    return read_knot_list(list, spec->size[a] + 1, "breakpoints", spec, a);
}

static ffd_status read_direction_knots(json_cursor cursor, lattice_spec *spec, size_t a)
{
    static const char *const names[] = {"clamped", "open", "uniform", "closed", "unclamped", "periodic"};
    static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM,
                                      KNOTS_CLOSED,  KNOTS_OPEN, KNOTS_CLOSED};
    if (ffd_cursor_is(cursor, JSON_ARRAY)) {
        spec->kind[a] = KNOTS_LIST;
        return read_knot_list(cursor, spec->size[a] + (size_t)spec->degree[a] + 1, "knots", spec, a);
    }
    if (ffd_cursor_is(cursor, JSON_OBJECT))
        return read_closed_list(cursor, spec, a);
    size_t index;
    TRY(ffd_json_read_word(cursor, names, COUNT_OF(names), &index));
    spec->kind[a] = kinds[index];
    return FFD_OK;
}

/* A closed direction needs control points at rest that form a ring. */
static ffd_status check_closed(json_cursor cursor, const lattice_spec *spec, size_t a)
{
    if (spec->kind[a] != KNOTS_CLOSED && spec->kind[a] != KNOTS_CLOSED_LIST)
        return FFD_OK;
    if (spec->rest == SPEC_BOX || spec->rest == SPEC_BOX_MESH)
        return ffd_cursor_fail(
            cursor, "direction %c of a box cannot be closed: its points do not form a ring", "uvw"[a]);
    if (spec->rest == SPEC_CYLINDER && a != 1)
        return ffd_cursor_fail(cursor, "direction %c of a cylinder cannot be closed, only v can", "uvw"[a]);
    if (spec->rest == SPEC_CYLINDER && !ffd_spec_full_turn(spec))
        return ffd_cursor_fail(cursor,
                               "a cylinder from %s to %s degrees cannot be closed: it is not a full turn",
                               ffd_number_text(spec->angle[0]).text, ffd_number_text(spec->angle[1]).text);
    return FFD_OK;
}

static ffd_status read_knots(json_cursor cursor, lattice_spec *spec)
{
    if (!ffd_cursor_exists(cursor)) {
        if (spec->rest == SPEC_CYLINDER && ffd_spec_full_turn(spec))
            spec->kind[1] = KNOTS_CLOSED;
        return FFD_OK;
    }
    TRY(ffd_json_read_array(cursor, 3, "knot vectors"));
    json_cursor knots = ffd_cursor_first(cursor);
    for (size_t a = 0; a < 3; a++, knots = ffd_cursor_next(knots)) {
        TRY(read_direction_knots(knots, spec, a));
        TRY(check_closed(knots, spec, a));
    }
    return FFD_OK;
}

static ffd_status read_weights(json_cursor cursor, size_t count, double **weights)
{
    TRY(ffd_json_read_array(cursor, count, "weights"));
    *weights = ffd_alloc(count, sizeof **weights);
    if (!*weights)
        return ffd_fail_memory(cursor.file->error);
    json_cursor weight = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count; i++, weight = ffd_cursor_next(weight)) {
        TRY(ffd_json_read_double(weight, *weights + i));
        if (!((*weights)[i] > 0))
            return ffd_cursor_fail(weight, "weight %s is not positive", ffd_number_text((*weights)[i]).text);
    }
    return FFD_OK;
}

static ffd_status read_deformed(json_cursor cursor, lattice_spec *spec)
{
    static const char *const keys[] = {"points", "offsets", "weights", SPEC_NOTES};
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    const json_cursor points = ffd_cursor_member(cursor, "points");
    const json_cursor offsets = ffd_cursor_member(cursor, "offsets");
    const json_cursor weights = ffd_cursor_member(cursor, "weights");
    if (ffd_cursor_exists(points) && ffd_cursor_exists(offsets))
        return ffd_cursor_fail(cursor, "has both \"points\" and \"offsets\"; the deformed control points are "
                                       "given by one of them");
    if (ffd_cursor_exists(points))
        TRY(ffd_spec_read_points(points, spec->count, &spec->deformed_points));
    if (ffd_cursor_exists(offsets))
        TRY(ffd_spec_read_points(offsets, spec->count, &spec->deformed_offsets));
    if (ffd_cursor_exists(weights))
        TRY(read_weights(weights, spec->count, &spec->deformed_weights));
    return FFD_OK;
}

static ffd_status read_units(json_cursor cursor, lattice_spec *spec)
{
    static const char *const names[] = {"world", "box", "mesh"};
    static const lattice_units units[] = {UNITS_WORLD, UNITS_BOX, UNITS_MESH};
    size_t index;
    TRY(ffd_json_read_word(cursor, names, COUNT_OF(names), &index));
    spec->units = units[index];
    if (spec->units != UNITS_MESH || spec->rest == SPEC_BOX_MESH)
        return FFD_OK;
    return ffd_cursor_fail(
        cursor, "\"mesh\" needs a rest box round a mesh: {\"box\": \"mesh\"} or {\"meshes\": [..]}");
}

static ffd_status read_rest_weights(json_cursor cursor, lattice_spec *spec)
{
    return read_weights(cursor, spec->count, &spec->weights);
}

static size_t line_of(json_cursor cursor)
{
    return ffd_cursor_exists(cursor) ? ffd_cursor_line(cursor) : 0;
}

/* Notes the lines of what is judged when the lattice is built. */
static void note_lines(json_cursor root, lattice_spec *spec)
{
    json_cursor knots = ffd_cursor_first(ffd_cursor_member(root, "knots"));
    for (int a = 0; a < 3 && ffd_cursor_exists(knots); a++, knots = ffd_cursor_next(knots))
        spec->knots_line[a] = ffd_cursor_line(knots);
    const json_cursor rest = ffd_cursor_member(root, "rest");
    spec->rest_line = line_of(ffd_cursor_first(rest));
    spec->units_line = line_of(ffd_cursor_member(root, "units"));
}

/* Reads all members except the moves, in the order of their dependencies. Only size and rest are required;
   the readers of degree and knots supply defaults. */
static ffd_status read_members(json_cursor root, lattice_spec *spec)
{
    static const struct member {
        const char *key;
        ffd_status (*read)(json_cursor cursor, lattice_spec *spec);
        bool required, has_default;
    } members[] = {
        {"size", read_size, true, false},
        {"degree", read_degree, false, true},
        {"rest", ffd_spec_parse_rest, true, false},
        {"knots", read_knots, false, true},
        {"weights", read_rest_weights, false, false},
        {"deformed", read_deformed, false, false},
        {"units", read_units, false, false},
    };
    for (size_t i = 0; i < COUNT_OF(members); i++) {
        const struct member *const member = &members[i];
        json_cursor cursor = ffd_cursor_member(root, member->key);
        if (member->required)
            TRY(ffd_json_require(root, member->key, &cursor));
        if (ffd_cursor_exists(cursor) || member->has_default)
            TRY(member->read(cursor, spec));
    }
    note_lines(root, spec);
    return FFD_OK;
}

/* Checked first, because in a newer version anything else may have another meaning. */
static ffd_status check_kind(json_cursor root)
{
    if (!ffd_cursor_is(root, JSON_OBJECT))
        return ffd_cursor_fail(root, "a lattice is an object, not %s", ffd_json_describe(root).text);
    TRY(read_format(root));
    return read_version(root);
}

static ffd_status read_root(json_cursor root, bool with_moves, lattice_spec *spec)
{
    const json_cursor moves = ffd_cursor_member(root, "moves");
    TRY(ffd_spec_refuse_actions(root));
    TRY(ffd_spec_read_object(root, top_keys, COUNT_OF(top_keys)));
    TRY(read_members(root, spec));
    if (with_moves && ffd_cursor_exists(moves))
        TRY(ffd_spec_parse_moves(moves, "/moves", spec));
    return FFD_OK;
}

/* Substitutes the placeholders, of which keys give some. */
static ffd_status set_values(json_file *file, const spec_settings *settings, const keyed_settings *keyed,
                             lattice_spec *spec, spec_values *values)
{
    uint32_t *lists;
    size_t count;
    TRY(ffd_spec_list_moves(ffd_cursor_top(file), &lists, &count));
    const ffd_status status = ffd_spec_set(file, lists, count, &keyed->settings, spec, values);
    ffd_free(lists);
    TRY(status);
    ffd_spec_mark_used(keyed, settings);
    if (settings->derives && spec->keys.kind == KEYS_POINTS && values->origins.count > 0)
        return ffd_cursor_fail_as(
            (json_cursor){file, file->tree, values->origins.origins[0].value, JSON_NONE}, FFD_E_UNSUPPORTED,
            "derivatives by placeholders in the moves of keys are not supported");
    return FFD_OK;
}

/* Reads the tree of a lattice file, with values for the placeholders in its moves. */
static ffd_status read_tree(json_file *file, const spec_settings *settings, lattice_spec *spec)
{
    keyed_settings keyed = {0};
    spec_values values = {0};
    json_trace trace = {0};
    ffd_status status;
    TRY_END(check_kind(ffd_cursor_top(file)));
    const json_cursor parameters = ffd_cursor_member(ffd_cursor_top(file), "parameters");
    if (ffd_cursor_exists(parameters))
        TRY_END(ffd_spec_parse_parameters(parameters, spec));
    TRY_END(ffd_spec_begin_keys(ffd_cursor_member(ffd_cursor_top(file), "keys"), settings, spec));
    TRY_END(ffd_spec_add_keyed(&spec->keys, settings, &keyed, file->error));
    TRY_END(set_values(file, settings, &keyed, spec, &values));
    if (settings->derives)
        file->trace = &trace;
    TRY_END(read_root(ffd_cursor_top(file), values.open.count == 0, spec));
    if (settings->derives && spec->keys.kind != KEYS_POINTS)
        TRY_END(ffd_spec_make_seeds(file, &values.origins, spec));
    TRY_END(ffd_spec_end_keys(ffd_cursor_top(file), &keyed, values.open.count == 0, spec));
end:
    file->trace = NULL;
    ffd_free(trace.entries);
    spec->open = values.open;
    values.open = (intern_table){0};
    ffd_spec_values_free(&values);
    ffd_keyed_settings_free(&keyed);
    return status;
}

/* Says what a file that is no JSON seems to be, in place of the character that was not expected. */
static void mention_content(const char *text, size_t size, const char *name, ffd_error *error)
{
    const content_kind *const kind = ffd_content_kind(text, size);
    if (!kind || kind->format == FFD_FORMAT_GLTF || ffd_content_is_utf16(text, size))
        return;
    ffd_fail_line(error, FFD_E_INVALID, name, 1, "not valid JSON");
    ffd_content_mention(kind, error);
}

ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                          lattice_spec **spec, ffd_error *error)
{
    static const spec_settings none = {.count = 0};
    const json_input input = {.text = text,
                              .size = size,
                              .name = name,
                              .rules = JSON_ALLOW_MARK | JSON_NO_NUL | JSON_DOUBLES | JSON_HAS_COMMENT};
    json_tree tree = {0};
    lattice_spec *result = NULL;
    *spec = NULL;
    ffd_status status = ffd_json_parse(&input, &tree, error);
    if (status == FFD_E_INVALID && error)
        mention_content(text, size, name, error);
    TRY_END(status);
    result = ffd_alloc_zero(1, sizeof *result);
    if (!result || !(result->name = ffd_text_copy(name)))
        TRY_END(ffd_fail_memory(error));
    json_file file = {.name = name, .tree = &tree, .error = error};
    TRY_END(read_tree(&file, settings ? settings : &none, result));
    *spec = result;
end:
    if (status) {
        ffd_fail_name_file(error, name);
        ffd_spec_free(result);
    }
    ffd_json_tree_free(&tree);
    return status;
}
