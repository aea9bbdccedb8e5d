#include "lattice/file/spec_parse_rest.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/direction.h"
#include "base/vector/vec.h"
#include "lattice/file/spec_values.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* How far the dot products of the axes of a box may be from 0 or 1: axes written with seven decimals pass.
   They are used as written, not orthonormalised, and min and max are coordinates along them. */
#define AXES_TOLERANCE 1e-6

static ffd_status check_axes(json_cursor cursor, const double axes[9])
{
    for (int r = 0; r < 3; r++)
        for (int s = r; s < 3; s++) {
            const double dot = vec_dot(axes + 3 * r, axes + 3 * s);
            if (r == s && !(fabs(dot - 1) <= AXES_TOLERANCE))
                return ffd_cursor_fail(cursor, "axis %d has the length %s, not 1", r,
                                       ffd_number_text(vec_length(axes + 3 * r)).text);
            if (r != s && !(fabs(dot) <= AXES_TOLERANCE))
                return ffd_cursor_fail(cursor,
                                       "axes %d and %d are not perpendicular: their dot product is %s", r, s,
                                       ffd_number_text(dot).text);
        }
    return FFD_OK;
}

static ffd_status read_axes(json_cursor cursor, double axes[9])
{
    TRY(ffd_json_read_array(cursor, 3, "axes"));
    json_cursor row = ffd_cursor_first(cursor);
    for (size_t r = 0; r < 3; r++, row = ffd_cursor_next(row))
        TRY(ffd_json_read_doubles(row, 3, axes + 3 * r));
    return check_axes(cursor, axes);
}

static ffd_status check_sides(json_cursor cursor, const lattice_spec *spec)
{
    for (int c = 0; c < 3; c++) {
        if (!(spec->box_min[c] < spec->box_max[c]))
            return ffd_cursor_fail(cursor, "max %s of direction %c is not more than min %s",
                                   ffd_number_text(spec->box_max[c]).text, "uvw"[c],
                                   ffd_number_text(spec->box_min[c]).text);
        if (!isfinite(spec->box_max[c] - spec->box_min[c]))
            return ffd_cursor_fail(cursor, "the side from %s to %s is too large for a double",
                                   ffd_number_text(spec->box_min[c]).text,
                                   ffd_number_text(spec->box_max[c]).text);
    }
    return FFD_OK;
}

static ffd_status read_spacing(json_cursor cursor, ffd_spacing *spacing)
{
    static const char *const names[] = {"greville", "uniform"};
    size_t index;
    const ffd_status status = ffd_json_read_word(cursor, names, COUNT_OF(names), &index);
    *spacing = index == 1 ? FFD_SPACING_UNIFORM : FFD_SPACING_GREVILLE;
    return status;
}

static ffd_status read_box(json_cursor cursor, lattice_spec *spec)
{
    static const char *const keys[] = {"min", "max", "spacing", "axes", "meshes", SPEC_NOTES};
    spec->rest = SPEC_BOX;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_spec_read_ends(cursor, spec->box_min, spec->box_max));
    const json_cursor spacing = ffd_cursor_member(cursor, "spacing"),
                      axes = ffd_cursor_member(cursor, "axes");
    spec->has_axes = ffd_cursor_exists(axes);
    if (ffd_cursor_exists(spacing))
        TRY(read_spacing(spacing, &spec->spacing));
    if (spec->has_axes)
        TRY(read_axes(axes, spec->box_axes));
    return check_sides(cursor, spec);
}

/* Reads a margin: a number, or one for each direction. */
static ffd_status read_margin(json_cursor cursor, double margin[3])
{
    if (ffd_cursor_is(cursor, JSON_ARRAY)) {
        TRY(ffd_json_read_doubles(cursor, 3, margin));
    } else {
        TRY(ffd_json_read_double(cursor, margin));
        margin[1] = margin[2] = margin[0];
    }
    for (int a = 0; a < 3; a++)
        if (margin[a] < 0)
            return ffd_cursor_fail(cursor, "margin %s is less than 0", ffd_number_text(margin[a]).text);
    return FFD_OK;
}

static ffd_status refuse_margin(json_cursor cursor)
{
    return ffd_cursor_fail(cursor, "a margin goes only with a box round meshes");
}

/* Refuses keys that belong elsewhere in "rest", for which a suggestion of the most similar key would
   mislead. */
static ffd_status refuse_misplaced(json_cursor box)
{
    static const char *const of_sides[] = {"min", "max", "spacing", "axes"};
    const bool meshes = ffd_cursor_exists(ffd_cursor_member(box, "meshes"));
    const json_cursor margin = ffd_cursor_member(box, "margin");
    for (size_t i = 0; i < COUNT_OF(of_sides) && meshes; i++) {
        const json_cursor member = ffd_cursor_member(box, of_sides[i]);
        if (ffd_cursor_exists(member))
            return ffd_cursor_fail(member,
                                   "\"%s\" goes only with a box that has \"min\" and \"max\": one round "
                                   "\"meshes\" is along x, y, z, and its control points are at the Greville "
                                   "abscissae",
                                   of_sides[i]);
    }
    if (!ffd_cursor_exists(margin))
        return FFD_OK;
    return meshes ? ffd_cursor_fail(margin, "a margin stands beside \"box\", not in it")
                  : refuse_margin(margin);
}

/* Reads {"meshes": [..]}, the files that the box goes round. */
static ffd_status read_meshes(json_cursor box, lattice_spec *spec)
{
    static const char *const keys[] = {"meshes", SPEC_NOTES};
    const json_cursor list = ffd_cursor_member(box, "meshes");
    TRY(ffd_spec_read_object(box, keys, COUNT_OF(keys)));
    spec->rest = SPEC_BOX_MESH;
    if (!ffd_cursor_is(list, JSON_ARRAY))
        return ffd_cursor_fail(list, "is not a list of mesh files");
    const size_t count = ffd_cursor_count(list);
    if (count == 0)
        return ffd_cursor_fail(list, "names no mesh");
    spec->meshes = ffd_alloc_zero(count, sizeof *spec->meshes);
    if (!spec->meshes)
        return ffd_fail_memory(box.file->error);
    json_cursor path = ffd_cursor_first(list);
    for (; spec->mesh_count < count; path = ffd_cursor_next(path)) {
        TRY(ffd_spec_read_path(path, &spec->meshes[spec->mesh_count]));
        spec->mesh_count++;
    }
    return FFD_OK;
}

/* Reads "box": {"min": ..}, or "box": "mesh" or {"meshes": ..} with a margin as the next member of "rest". */
static ffd_status read_any_box(json_cursor rest, lattice_spec *spec)
{
    static const char *const names[] = {"mesh"};
    const json_cursor box = ffd_cursor_member(rest, "box"), margin = ffd_cursor_member(rest, "margin");
    size_t index;
    TRY(refuse_misplaced(box));
    if (ffd_cursor_is(box, JSON_STRING)) {
        spec->rest = SPEC_BOX_MESH;
        TRY(ffd_json_read_word(box, names, COUNT_OF(names), &index));
    } else if (ffd_cursor_exists(ffd_cursor_member(box, "meshes"))) {
        TRY(read_meshes(box, spec));
    } else {
        TRY(read_box(box, spec));
    }
    if (!ffd_cursor_exists(margin))
        return FFD_OK;
    return spec->rest == SPEC_BOX_MESH ? read_margin(margin, spec->margin) : refuse_margin(margin);
}

static ffd_status read_zero(json_cursor cylinder, lattice_spec *spec)
{
    const json_cursor zero = ffd_cursor_member(cylinder, "zero");
    if (!ffd_cursor_exists(zero)) {
        ffd_direction_default_zero(spec->axis, spec->zero);
        return FFD_OK;
    }
    TRY(ffd_spec_read_axis(cylinder, "zero", spec->zero));
    if (ffd_direction_perpendicular(spec->axis, spec->zero))
        return FFD_OK;
    return ffd_cursor_fail(zero, "is parallel to the axis, which it must not be");
}

static ffd_status read_radius(json_cursor cylinder, double radius[2])
{
    TRY(ffd_json_member_doubles(cylinder, "radius", 2, radius));
    if ((radius[0] >= 0 && radius[0] < radius[1]))
        return FFD_OK;
    return ffd_cursor_fail(ffd_cursor_member(cylinder, "radius"), "radii %s and %s are not 0 <= r0 < r1",
                           ffd_number_text(radius[0]).text, ffd_number_text(radius[1]).text);
}

static ffd_status read_angle(json_cursor cylinder, double angle[2])
{
    const json_cursor cursor = ffd_cursor_member(cylinder, "angle");
    angle[0] = 0;
    angle[1] = 360;
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    TRY(ffd_json_read_doubles(cursor, 2, angle));
    const double sweep = angle[1] - angle[0];
    if (sweep > 0 && sweep <= 360 + SPEC_TURN_TOLERANCE)
        return FFD_OK;
    return ffd_cursor_fail(cursor, "%s to %s degrees is not an angle of more than 0, at most 360",
                           ffd_number_text(angle[0]).text, ffd_number_text(angle[1]).text);
}

static ffd_status read_cylinder(json_cursor cursor, lattice_spec *spec)
{
    static const char *const keys[] = {"center", "axis", "zero", "radius", "height", "angle", SPEC_NOTES};
    spec->rest = SPEC_CYLINDER;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_json_member_doubles(cursor, "center", 3, spec->center));
    TRY(ffd_spec_read_axis(cursor, "axis", spec->axis));
    TRY(read_zero(cursor, spec));
    TRY(read_radius(cursor, spec->radius));
    TRY(ffd_spec_read_positive(cursor, "height", &spec->height));
    return read_angle(cursor, spec->angle);
}

ffd_status ffd_spec_parse_rest(json_cursor cursor, lattice_spec *spec)
{
    static const char *const keys[] = {"box", "cylinder", "points", "margin", SPEC_NOTES};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            spec->box_axes[3 * r + c] = r == c;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    const json_cursor box = ffd_cursor_member(cursor, "box"),
                      cylinder = ffd_cursor_member(cursor, "cylinder"),
                      points = ffd_cursor_member(cursor, "points");
    if (ffd_cursor_exists(box) + ffd_cursor_exists(cylinder) + ffd_cursor_exists(points) != 1)
        return ffd_cursor_fail(cursor, "needs exactly one of \"box\", \"cylinder\", \"points\"");
    if (ffd_cursor_exists(box))
        return read_any_box(cursor, spec);
    if (ffd_cursor_exists(ffd_cursor_member(cursor, "margin")))
        return refuse_margin(cursor);
    if (ffd_cursor_exists(cylinder))
        return read_cylinder(cylinder, spec);
    spec->rest = SPEC_POINTS;
    return ffd_spec_read_points(points, spec->count, &spec->points);
}
