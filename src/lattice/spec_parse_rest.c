#include "base/text/number.h"
#include "base/vector/vec.h"
#include "lattice/direction.h"
#include "lattice/spec_parse.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* How far the axes of a box may be from orthonormal (each dot product from 0 or 1): seven decimals suffice.
   They are then used as written: min and max are along them, whatever their last digits. */
#define AXES_TOLERANCE 1e-6

static ffd_status check_axes(json_place *place, const double axes[9])
{
    for (int r = 0; r < 3; r++)
        for (int s = r; s < 3; s++) {
            const double dot = vec_dot(axes + 3 * r, axes + 3 * s);
            if (r == s && !(fabs(dot - 1) <= AXES_TOLERANCE))
                return ffd_place_fail(place, "axis %d has the length %s, not 1", r,
                                      ffd_number_text(vec_length(axes + 3 * r)).text);
            if (r != s && !(fabs(dot) <= AXES_TOLERANCE))
                return ffd_place_fail(place, "axes %d and %d are not perpendicular: their dot product is %s",
                                      r, s, ffd_number_text(dot).text);
        }
    return FFD_OK;
}

static ffd_status read_axes(json_place *place, const json_t *value, double axes[9])
{
    ffd_status status = ffd_json_read_array(place, value, 3, "axes");
    for (size_t r = 0; r < 3 && !status; r++) {
        const size_t before = ffd_place_enter_index(place, r);
        status = ffd_json_read_doubles(place, json_array_get(value, r), 3, axes + 3 * r);
        ffd_place_leave(place, before);
    }
    return status ? status : check_axes(place, axes);
}

static ffd_status check_sides(json_place *place, const lattice_spec *spec)
{
    for (int c = 0; c < 3; c++) {
        if (!(spec->box_min[c] < spec->box_max[c]))
            return ffd_place_fail(place, "max %s of direction %c is not more than min %s",
                                  ffd_number_text(spec->box_max[c]).text, "uvw"[c],
                                  ffd_number_text(spec->box_min[c]).text);
        if (!isfinite(spec->box_max[c] - spec->box_min[c]))
            return ffd_place_fail(place, "the side from %s to %s is longer than numbers can hold",
                                  ffd_number_text(spec->box_min[c]).text,
                                  ffd_number_text(spec->box_max[c]).text);
    }
    return FFD_OK;
}

static ffd_status read_spacing(json_place *place, const json_t *value, ffd_spacing *spacing)
{
    static const char *const names[] = {"greville", "uniform"};
    size_t index;
    const ffd_status status = ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
    *spacing = index == 1 ? FFD_SPACING_UNIFORM : FFD_SPACING_GREVILLE;
    return status;
}

static ffd_status read_box(json_place *place, const json_t *value, lattice_spec *spec)
{
    static const char *const keys[] = {"min", "max", "spacing", "axes"};
    spec->rest = SPEC_BOX;
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_json_member_doubles(place, value, "min", 3, spec->box_min);
    if (!status)
        status = ffd_json_member_doubles(place, value, "max", 3, spec->box_max);
    const json_t *const spacing = json_object_get(value, "spacing"), *const axes =
                                                                         json_object_get(value, "axes");
    if (!status && spacing) {
        const size_t before = ffd_place_enter(place, "spacing");
        status = read_spacing(place, spacing, &spec->spacing);
        ffd_place_leave(place, before);
    }
    if (!status && axes) {
        const size_t before = ffd_place_enter(place, "axes");
        spec->has_axes = true;
        status = read_axes(place, axes, spec->box_axes);
        ffd_place_leave(place, before);
    }
    return status ? status : check_sides(place, spec);
}

static ffd_status read_margin(json_place *place, const json_t *value, double *margin)
{
    const ffd_status status = ffd_json_read_double(place, value, margin);
    if (!status && *margin < 0)
        return ffd_place_fail(place, "margin %s is less than 0", ffd_number_text(*margin).text);
    return status;
}

/* "box": {...}, or "box": "mesh" with a margin beside it. */
static ffd_status read_any_box(json_place *place, const json_t *rest, lattice_spec *spec)
{
    static const char *const names[] = {"mesh"};
    const json_t *const box = json_object_get(rest, "box"), *const margin = json_object_get(rest, "margin");
    size_t index, before = ffd_place_enter(place, "box");
    ffd_status status;
    if (json_is_string(box)) {
        spec->rest = SPEC_BOX_MESH;
        status = ffd_json_read_word(place, box, names, COUNT_OF(names), &index);
    } else {
        status = read_box(place, box, spec);
    }
    ffd_place_leave(place, before);
    if (status || !margin)
        return status;
    before = ffd_place_enter(place, "margin");
    if (spec->rest == SPEC_BOX_MESH)
        status = read_margin(place, margin, &spec->margin);
    else
        status = ffd_place_fail(place, "a margin goes only with \"box\": \"mesh\"");
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_zero(json_place *place, const json_t *cylinder, lattice_spec *spec)
{
    if (!json_object_get(cylinder, "zero")) {
        ffd_direction_default_zero(spec->axis, spec->zero);
        return FFD_OK;
    }
    const ffd_status status = ffd_spec_parse_axis(place, cylinder, "zero", spec->zero);
    if (status || ffd_direction_perpendicular(spec->axis, spec->zero))
        return status;
    ffd_place_enter(place, "zero");
    return ffd_place_fail(place, "points along the axis; it must lead away from it");
}

static ffd_status read_radius(json_place *place, const json_t *cylinder, double radius[2])
{
    const ffd_status status = ffd_json_member_doubles(place, cylinder, "radius", 2, radius);
    if (status || (radius[0] >= 0 && radius[0] < radius[1]))
        return status;
    ffd_place_enter(place, "radius");
    return ffd_place_fail(place, "radii %s and %s are not 0 <= r0 < r1", ffd_number_text(radius[0]).text,
                          ffd_number_text(radius[1]).text);
}

static ffd_status read_height(json_place *place, const json_t *cylinder, double *height)
{
    const ffd_status status = ffd_json_member_double(place, cylinder, "height", height);
    if (status || *height > 0)
        return status;
    ffd_place_enter(place, "height");
    return ffd_place_fail(place, "height %s is not more than 0", ffd_number_text(*height).text);
}

static ffd_status read_angle(json_place *place, const json_t *cylinder, double angle[2])
{
    angle[0] = 0;
    angle[1] = 360;
    if (!json_object_get(cylinder, "angle"))
        return FFD_OK;
    const ffd_status status = ffd_json_member_doubles(place, cylinder, "angle", 2, angle);
    if (status)
        return status;
    const double span = angle[1] - angle[0];
    if (span > 0 && span <= 360 + SPEC_TURN_TOLERANCE)
        return FFD_OK;
    ffd_place_enter(place, "angle");
    return ffd_place_fail(place, "%s to %s degrees is not an angle of more than 0, at most 360",
                          ffd_number_text(angle[0]).text, ffd_number_text(angle[1]).text);
}

static ffd_status read_cylinder(json_place *place, const json_t *value, lattice_spec *spec)
{
    static const char *const keys[] = {"center", "axis", "zero", "radius", "height", "angle"};
    spec->rest = SPEC_CYLINDER;
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_json_member_doubles(place, value, "center", 3, spec->center);
    if (!status)
        status = ffd_spec_parse_axis(place, value, "axis", spec->axis);
    if (!status)
        status = read_zero(place, value, spec);
    if (!status)
        status = read_radius(place, value, spec->radius);
    if (!status)
        status = read_height(place, value, &spec->height);
    if (!status)
        status = read_angle(place, value, spec->angle);
    return status;
}

ffd_status ffd_spec_parse_rest(json_place *place, const json_t *value, lattice_spec *spec)
{
    static const char *const keys[] = {"box", "cylinder", "points", "margin"};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            spec->box_axes[3 * r + c] = r == c;
    const ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (status)
        return status;
    const json_t *const cylinder = json_object_get(value, "cylinder"), *const points =
                                                                           json_object_get(value, "points");
    const bool box = json_object_get(value, "box") != NULL;
    if (box + (cylinder != NULL) + (points != NULL) != 1)
        return ffd_place_fail(place, "needs exactly one of \"box\", \"cylinder\", \"points\"");
    if (box)
        return read_any_box(place, value, spec);
    if (json_object_get(value, "margin"))
        return ffd_place_fail(place, "a margin goes only with \"box\": \"mesh\"");
    ffd_place_enter(place, cylinder ? "cylinder" : "points");
    if (cylinder)
        return read_cylinder(place, cylinder, spec);
    spec->rest = SPEC_POINTS;
    return ffd_spec_parse_points(place, points, spec->count, &spec->points);
}
