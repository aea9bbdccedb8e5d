/* blender_json.c - lattices of Blender as an add-on once kept them: JSON with "deformed_control_points",
   whose points at rest are those that Blender makes. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "lattice/formats/blender.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include "json/json_parse.h"
#include "json/json_reader.h"

#define POINTS "deformed_control_points"
#define DEGREES 57.295779513082320876798 /* of a radian */

static const char *const types[] = {"KEY_LINEAR", "KEY_CARDINAL", "KEY_CATMULL_ROM", "KEY_BSPLINE"};

bool ffd_blender_is_json(const file_input *file)
{
    const char *const first = (const char *)file->data, *const last = first + file->size;
    text_scan scan;
    ffd_text_begin(&scan, first, file->size, false);
    return ffd_text_find(&scan) && *scan.at == '{' && ffd_find_text(first, last, "\"" POINTS "\"") &&
           !ffd_find_text(first, last, "\"format\"");
}

/* Rx, then Ry, then Rz, by radians. */
static void find_rotation(const double angles[3], double rotation[9])
{
    double all[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int a = 0; a < 3; a++) {
        double turn[9], next[9];
        ffd_axis_rotation(a, angles[a] * DEGREES, turn);
        mat_multiply(turn, all, next);
        memcpy(all, next, sizeof next);
    }
    memcpy(rotation, all, sizeof all);
}

static ffd_status read_types(json_cursor top, blender_lattice *lattice)
{
    static const char *const keys[] = {"lattice_interpolation_u", "lattice_interpolation_v",
                                       "lattice_interpolation_w"};
    for (int d = 0; d < 3; d++) {
        const json_cursor member = ffd_cursor_member(top, keys[d]);
        size_t type = BLENDER_BSPLINE;
        if (ffd_cursor_exists(member))
            TRY(ffd_json_read_word(member, types, sizeof types / sizeof *types, &type));
        lattice->type[d] = (blender_type)type;
    }
    return FFD_OK;
}

static ffd_status read_shape(json_cursor top, blender_lattice *lattice)
{
    double size[3], angles[3], count = 1;
    TRY(ffd_json_member_doubles(top, "lattice_points", 3, size));
    TRY(ffd_json_member_doubles(top, "lattice_object_location", 3, lattice->location));
    TRY(ffd_json_member_doubles(top, "lattice_object_rotation", 3, angles));
    TRY(ffd_json_member_doubles(top, "lattice_object_scale", 3, lattice->scale));
    find_rotation(angles, lattice->rotation);
    for (int d = 0; d < 3; d++) {
        if (!(size[d] >= 1) || size[d] > (double)FFD_MAX_CONTROL_POINTS || size[d] != floor_of(size[d]))
            return ffd_cursor_fail(ffd_cursor_member(top, "lattice_points"), "%g is not a number of points",
                                   size[d]);
        lattice->size[d] = (size_t)size[d];
        lattice->first[d] = size[d] > 1 ? -0.5 : 0;
        lattice->step[d] = size[d] > 1 ? 1 / (size[d] - 1) : 0;
        count *= size[d];
    }
    return count <= (double)FFD_MAX_CONTROL_POINTS
               ? FFD_OK
               : ffd_cursor_fail_as(ffd_cursor_member(top, "lattice_points"), FFD_E_LIMIT,
                                    "there are more than %zu points", FFD_MAX_CONTROL_POINTS);
}

static ffd_status read_strength(json_cursor top, double *strength)
{
    const json_cursor member = ffd_cursor_member(ffd_cursor_member(top, "lattice_modifier"), "strength");
    *strength = 1;
    return ffd_cursor_exists(member) ? ffd_json_read_double(member, strength) : FFD_OK;
}

/* The offsets of the deformed points from those at rest, times the strength. */
static ffd_status read_offsets(json_cursor top, blender_lattice *lattice)
{
    const size_t *const n = lattice->size;
    const size_t count = n[0] * n[1] * n[2];
    json_cursor points;
    double strength;
    size_t i = 0;
    TRY(read_strength(top, &strength));
    TRY(ffd_json_require(top, POINTS, &points));
    TRY(ffd_json_read_array(points, count, "points"));
    lattice->offsets = ffd_alloc(count, 3 * sizeof *lattice->offsets);
    if (!lattice->offsets)
        return ffd_fail_memory(points.file->error);
    for (json_cursor at = ffd_cursor_first(points); ffd_cursor_exists(at); at = ffd_cursor_next(at), i++) {
        const size_t index[3] = {i % n[0], i / n[0] % n[1], i / (n[0] * n[1])};
        double *const offset = lattice->offsets + 3 * i;
        TRY(ffd_json_read_doubles(at, 3, offset));
        for (int d = 0; d < 3; d++)
            offset[d] = strength * (offset[d] - (lattice->first[d] + (double)index[d] * lattice->step[d]));
    }
    return FFD_OK;
}

ffd_status ffd_lattice_read_blender_json(const file_input *file, const char *name, const format_wish *wish,
                                         lattice_spec **spec, ffd_error *error)
{
    const json_input input = {.text = (const char *)file->data,
                              .size = file->size,
                              .name = name,
                              .rules = JSON_ALLOW_MARK | JSON_NO_NUL | JSON_DOUBLES};
    blender_lattice lattice = {.offsets = NULL};
    json_tree tree = {0};
    ffd_status status;
    *spec = NULL;
    TRY_END(ffd_json_parse(&input, &tree, error));
    const json_file parsed = {.name = name, .tree = &tree, .error = error};
    const json_cursor top = ffd_cursor_top(&parsed);
    TRY_END(read_types(top, &lattice));
    TRY_END(read_shape(top, &lattice));
    TRY_END(read_offsets(top, &lattice));
    TRY_END(ffd_blender_make(&lattice, name, wish, spec, error));
end:
    if (status)
        ffd_fail_name_file(error, name);
    ffd_free(lattice.offsets);
    ffd_json_tree_free(&tree);
    return status;
}
