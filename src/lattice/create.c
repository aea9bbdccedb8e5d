/* create.c - ffd_lattice_create: makes a lattice round points from the caller's description. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/struct_size.h"
#include "base/vector/direction.h"
#include "base/vector/principal.h"
#include "base/vector/vec.h"
#include "lattice/build.h"
#include "lattice/lattice.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <float.h>
#include <string.h>

void ffd_lattice_desc_init(ffd_lattice_desc *desc, size_t size)
{
    const ffd_lattice_desc defaults = {
        .struct_size = sizeof defaults, .size = {4, 4, 4}, .margin = {0.05, 0.05, 0.05}, .axis = {0, 0, 1}};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static ffd_status check_counts(const ffd_lattice_desc *desc, ffd_error *error)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        const int degree = desc->degree[a];
        if (desc->size[a] < 2)
            return ffd_fail(
                error, FFD_E_ARGUMENT, "{size} %zu along %c is less than 2%s", desc->size[a], "uvw"[a],
                desc -> size[a] < 1 ? ""
                                    : SPELLED(": a plane needs two layers that move alike: {size} 5,5,2, "
                                              "{degree} 3,3,1, and \"at\": [i, j, \"all\"]"));
        if (desc->size[a] > FFD_MAX_CONTROL_POINTS / count)
            return ffd_fail(error, FFD_E_LIMIT,
                            "{size}: a lattice of %zu by %zu by %zu has more than %zu control points",
                            desc->size[0], desc->size[1], desc->size[2], FFD_MAX_CONTROL_POINTS);
        count *= desc->size[a];
        if (degree < 0 || degree > MAX_DEGREE)
            return ffd_fail(error, FFD_E_ARGUMENT, "{degree} %d along %c is not between 1 and %d%s", degree,
                            "uvw"[a], MAX_DEGREE, ffd_degree_hint(degree));
        if (desc->size[a] <= (size_t)degree)
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "{degree} %d along %c needs {size} %d or more there, not %zu", degree, "uvw"[a],
                            degree + 1, desc->size[a]);
    }
    return FFD_OK;
}

static ffd_status check_knots(const ffd_lattice_desc *desc, ffd_error *error)
{
    const bool cylinder = desc->shape == FFD_SHAPE_CYLINDER;
    for (int a = 0; a < 3; a++) {
        if ((int)desc->knots[a] < FFD_KNOTS_DEFAULT || desc->knots[a] > FFD_KNOTS_CLOSED)
            return ffd_fail(error, FFD_E_ARGUMENT, "{knots}: %d is not a kind of knots", (int)desc->knots[a]);
        if (desc->knots[a] == FFD_KNOTS_CLOSED && !(cylinder && a == 1))
            return ffd_fail(error, FFD_E_ARGUMENT, "{knots=closed}: direction %c of a %s cannot be closed",
                            "uvw"[a], cylinder ? "cylinder" : "box");
        if (desc->spacing == FFD_SPACING_UNIFORM && desc->knots[a] > FFD_KNOTS_CLAMPED)
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "{spacing=uniform} needs {knots=clamped}, which direction %c does not have",
                            "uvw"[a]);
    }
    return FFD_OK;
}

static ffd_status check_desc(const ffd_lattice_desc *desc, ffd_error *error)
{
    const bool cylinder = desc->shape == FFD_SHAPE_CYLINDER;
    if (!cylinder && desc->shape != FFD_SHAPE_BOX)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a shape of lattices", (int)desc->shape);
    if (desc->spacing != FFD_SPACING_GREVILLE && desc->spacing != FFD_SPACING_UNIFORM)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a kind of spacing", (int)desc->spacing);
    for (int a = 0; a < 3; a++)
        if (!(desc->margin[a] >= 0) || !isfinite(desc->margin[a]))
            return ffd_fail(error, FFD_E_ARGUMENT, "{margin} %g is not 0 or more", desc->margin[a]);
    if (cylinder && desc->spacing != FFD_SPACING_GREVILLE)
        return ffd_fail(error, FFD_E_ARGUMENT, "{spacing=uniform} is for boxes, not for cylinders");
    if (cylinder && (desc->margin[0] != desc->margin[1] || desc->margin[1] != desc->margin[2]))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "{margin} %g %g %g is for boxes; a cylinder has one, of its radius and height",
                        desc->margin[0], desc->margin[1], desc->margin[2]);
    if (cylinder && desc->principal)
        return ffd_fail(error, FFD_E_ARGUMENT, "{principal} is for boxes; a cylinder has its own {axis}");
    if (cylinder &&
        (!vec_is_finite(desc->axis) || (desc->axis[0] == 0 && desc->axis[1] == 0 && desc->axis[2] == 0)))
        return ffd_fail(error, FFD_E_ARGUMENT, "{axis} %g %g %g of the cylinder is not a direction",
                        desc->axis[0], desc->axis[1], desc->axis[2]);
    TRY(check_counts(desc, error));
    return check_knots(desc, error);
}

/* Finds the bounds of the finite points along three directions (rows of axes). Returns false if no point is
   finite. */
static bool find_bounds(const double *xyz, size_t count, const double axes[9], double min[3], double max[3])
{
    bool any = false;
    for (int a = 0; a < 3; a++) {
        min[a] = INFINITY;
        max[a] = -INFINITY;
    }
    for (size_t i = 0; i < count; i++) {
        const double *const p = xyz + 3 * i;
        if (!vec_is_finite(p))
            continue;
        any = true;
        double along[3];
        mat_apply(axes, p, along);
        for (int a = 0; a < 3; a++) {
            min[a] = minimum_number(min[a], along[a]);
            max[a] = maximum_number(max[a], along[a]);
        }
    }
    return any;
}

static ffd_status find_bounds_or_fail(const double *xyz, size_t count, const double axes[9], double min[3],
                                      double max[3], ffd_error *error)
{
    if (find_bounds(xyz, count, axes, min, max))
        return FFD_OK;
    return ffd_fail(error, FFD_E_INVALID, "there is no finite point to put a lattice around");
}

static void fill_common(const ffd_lattice_desc *desc, lattice_spec *spec)
{
    static const knot_kind kinds[] = {
        [FFD_KNOTS_DEFAULT] = KNOTS_CLAMPED, [FFD_KNOTS_CLAMPED] = KNOTS_CLAMPED,
        [FFD_KNOTS_OPEN] = KNOTS_OPEN,       [FFD_KNOTS_UNIFORM] = KNOTS_UNIFORM,
        [FFD_KNOTS_CLOSED] = KNOTS_CLOSED,
    };
    spec->count = 1;
    for (int a = 0; a < 3; a++) {
        spec->size[a] = desc->size[a];
        spec->count *= desc->size[a];
        spec->degree[a] = desc->degree[a] ? desc->degree[a] : desc->size[a] > 3 ? 3 : (int)desc->size[a] - 1;
        spec->kind[a] = kinds[desc->knots[a]];
    }
    spec->spacing = desc->spacing;
}

static const double world_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static ffd_status use_principal_axes(const double *xyz, size_t count, double axes[9], ffd_error *error)
{
    double min[3], max[3], center[3], length = 0;
    TRY(find_bounds_or_fail(xyz, count, world_axes, min, max, error));
    for (int c = 0; c < 3; c++) {
        center[c] = 0.5 * min[c] + 0.5 * max[c];
        length = maximum_number(length, max[c] - min[c]);
    }
    if (length > 0 && isfinite(length))
        ffd_principal_axes(xyz, count, center, length, axes);
    return FFD_OK;
}

/* The rounding error of coordinates along other axes than x, y, z, relative to the magnitude of the
   coordinates. Far from the origin it exceeds the tolerance of the search along a short axis of the lattice.
   So a box without margin is widened by it, to hold all points. */
#define AXES_ROUNDING (16 * DBL_EPSILON)

static double rounding_of_axes(const double *xyz, size_t count)
{
    double min[3], max[3], size = 0;
    if (find_bounds(xyz, count, world_axes, min, max))
        for (int c = 0; c < 3; c++)
            size += AXES_ROUNDING * maximum_number(fabs(min[c]), fabs(max[c]));
    return size;
}

static ffd_status fill_box(const ffd_lattice_desc *desc, const double *xyz, size_t count, lattice_spec *spec,
                           ffd_error *error)
{
    double min[3], max[3];
    spec->rest = SPEC_BOX;
    spec->has_axes = desc->principal;
    for (int i = 0; i < 9; i++)
        spec->box_axes[i] = world_axes[i];
    if (desc->principal)
        TRY(use_principal_axes(xyz, count, spec->box_axes, error));
    TRY(find_bounds_or_fail(xyz, count, spec->box_axes, min, max, error));
    TRY(ffd_shape_grow_box(min, max, desc->margin, spec->box_min, spec->box_max, error));
    const double rounding = desc->principal ? rounding_of_axes(xyz, count) : 0;
    for (int a = 0; a < 3; a++) {
        spec->box_min[a] = minimum_number(spec->box_min[a], min[a] - rounding);
        spec->box_max[a] = maximum_number(spec->box_max[a], max[a] + rounding);
        if (!isfinite(spec->box_max[a] - spec->box_min[a]))
            return ffd_fail(error, FFD_E_INVALID, "a box of side %g is too large for a double",
                            max[a] - min[a]);
    }
    return FFD_OK;
}

/* Returns the greatest distance of a point from the axis through the middle, measured along zero and side. */
static double greatest_radius(const double *xyz, size_t count, const double frame[9], const double middle[3])
{
    double greatest = 0;
    for (size_t i = 0; i < count; i++) {
        double p[3];
        mat_apply(frame, xyz + 3 * i, p);
        const double x = p[0] - middle[0], y = p[1] - middle[1], square = x * x + y * y;
        if (vec_is_finite(xyz + 3 * i))
            greatest = maximum_number(greatest, square);
    }
    return sqrt(greatest);
}

/* The margin is a fraction of the cylinder's diameter and of its height. */
static ffd_status fill_cylinder(const ffd_lattice_desc *desc, const double *xyz, size_t count,
                                lattice_spec *spec, ffd_error *error)
{
    static const double none[3] = {0, 0, 0};
    double frame[9], min[3], max[3], grown_min[3], grown_max[3], middle[3];
    double *const zero = frame, *const side = frame + 3, *const axis = frame + 6;
    for (int c = 0; c < 3; c++)
        axis[c] = desc->axis[c];
    ffd_direction_unit(axis);
    ffd_direction_default_zero(axis, zero);
    vec_cross(axis, zero, side);
    TRY(find_bounds_or_fail(xyz, count, frame, min, max, error));
    /* Without margin: only to widen flat sides and to refuse bounds that are too large. */
    TRY(ffd_shape_grow_box(min, max, none, grown_min, grown_max, error));
    for (int a = 0; a < 3; a++)
        middle[a] = 0.5 * grown_min[a] + 0.5 * grown_max[a];
    const double least = 0.5 * minimum_number(grown_max[0] - grown_min[0], grown_max[1] - grown_min[1]);
    const double radius = maximum_number(greatest_radius(xyz, count, frame, middle), least);
    spec->rest = SPEC_CYLINDER;
    const double height = grown_max[2] - grown_min[2], rounding = rounding_of_axes(xyz, count);
    spec->radius[1] = maximum_number(radius * (1 + 2 * desc->margin[0]), radius + rounding);
    spec->height = maximum_number(height * (1 + 2 * desc->margin[0]), height + 2 * rounding);
    spec->angle[1] = 360;
    for (int c = 0; c < 3; c++) {
        spec->center[c] = zero[c] * middle[0] + side[c] * middle[1] + axis[c] * middle[2];
        spec->axis[c] = axis[c];
        spec->zero[c] = zero[c];
    }
    if (desc->knots[1] == FFD_KNOTS_DEFAULT)
        spec->kind[1] = KNOTS_CLOSED;
    if (isfinite(spec->radius[1]) && isfinite(spec->height))
        return FFD_OK;
    return ffd_fail(error, FFD_E_INVALID, "a cylinder of radius %g and height %g is too large for a double",
                    spec->radius[1], spec->height);
}

/* Too few control points for a cylinder are the description's fault: there is no file with this pointer. */
static ffd_status build(lattice_spec *spec, ffd_lattice **lattice, ffd_error *error)
{
    ffd_error own;
    ffd_error *const found = error ? error : &own;
    const ffd_status status = ffd_spec_build(spec, NULL, lattice, found);
    if (status != FFD_E_INVALID || strcmp(found->pointer, "/rest/cylinder") != 0)
        return status;
    own = *found;
    return ffd_fail(error, FFD_E_ARGUMENT, "{size}: %s", own.message);
}

ffd_status ffd_lattice_create(const ffd_lattice_desc *callers, const double *xyz, size_t count,
                              ffd_lattice **lattice, ffd_error *error)
{
    ffd_lattice_desc own;
    const ffd_lattice_desc *const desc = &own;
    *lattice = NULL;
    ffd_lattice_desc_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, callers, "ffd_lattice_desc", error));
    TRY(check_desc(desc, error));
    lattice_spec *const spec = ffd_alloc_zero(1, sizeof *spec);
    ffd_status status;
    TRY_END(spec && (spec->name = ffd_text_copy("")) ? FFD_OK : ffd_fail_memory(error));
    fill_common(desc, spec);
    TRY_END((desc->shape == FFD_SHAPE_CYLINDER ? fill_cylinder : fill_box)(desc, xyz, count, spec, error));
    TRY_END(build(spec, lattice, error));
end:
    if (status)
        ffd_spec_free(spec);
    return status;
}
