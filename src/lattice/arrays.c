/* arrays.c - ffd_lattice_from_arrays: makes a lattice from the caller's arrays. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include "lattice/build.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <math.h>
#include <string.h>

void ffd_lattice_arrays_init(ffd_lattice_arrays *arrays, size_t size)
{
    const ffd_lattice_arrays defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, arrays, size);
}

/* Copies count numbers; *to is NULL if from is NULL. Returns false if memory runs out. */
static bool copy_numbers(const double *from, size_t count, double **to)
{
    *to = from ? ffd_alloc(count, sizeof **to) : NULL;
    if (*to)
        memcpy(*to, from, count * sizeof **to);
    return !from || *to;
}

static ffd_status fill_shape(const ffd_lattice_arrays *arrays, lattice_spec *spec, ffd_error *error)
{
    spec->count = 1;
    for (int a = 0; a < 3; a++) {
        const size_t size = arrays->size[a];
        const int degree = arrays->degree[a] ? arrays->degree[a] : size > 3 ? 3 : (int)size - 1;
        if (size < 2)
            return ffd_fail(
                error, FFD_E_ARGUMENT, "size %zu along %c is less than 2%s", size, "uvw"[a],
                size < 1 ? "" : ": a plane needs two layers that move alike, with degree 1 between them");
        if (size > FFD_MAX_CONTROL_POINTS / spec->count)
            return ffd_fail(error, FFD_E_LIMIT,
                            "a lattice of %zu by %zu by %zu has more than %zu control points",
                            arrays->size[0], arrays->size[1], arrays->size[2], FFD_MAX_CONTROL_POINTS);
        if (degree < 1 || degree > MAX_DEGREE || (size_t)degree >= size)
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "degree %d along %c is not between 1 and %d, and less than the size %zu%s",
                            degree, "uvw"[a], MAX_DEGREE, size, ffd_degree_hint(degree));
        spec->size[a] = size;
        spec->degree[a] = degree;
        spec->count *= size;
    }
    return FFD_OK;
}

static ffd_status fill_knots(const ffd_lattice_arrays *arrays, lattice_spec *spec, ffd_error *error)
{
    static const knot_kind kinds[] = {KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM, KNOTS_CLOSED};
    for (int a = 0; a < 3; a++) {
        const bool closed = arrays->knots[a] == FFD_KNOTS_CLOSED, listed = arrays->knot_values[a] != NULL;
        const size_t count = closed ? spec->size[a] + 1 : spec->size[a] + (size_t)spec->degree[a] + 1;
        if ((int)arrays->knots[a] < FFD_KNOTS_DEFAULT || arrays->knots[a] > FFD_KNOTS_CLOSED)
            return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a kind of knots", (int)arrays->knots[a]);
        if (closed && !arrays->rest)
            return ffd_fail(error, FFD_E_ARGUMENT, "direction %c of a box cannot be closed", "uvw"[a]);
        if (listed && arrays->knot_count[a] != count)
            return ffd_fail(error, FFD_E_ARGUMENT, "direction %c needs %zu %s, not %zu", "uvw"[a], count,
                            closed ? "breakpoints" : "knots", arrays->knot_count[a]);
        spec->kind[a] = !listed ? kinds[arrays->knots[a]] : closed ? KNOTS_CLOSED_LIST : KNOTS_LIST;
        spec->list_count[a] = listed ? count : 0;
        for (size_t i = 0; listed && i < count; i++)
            if (!isfinite(arrays->knot_values[a][i]))
                return ffd_fail(error, FFD_E_INVALID, "knot %zu of direction %c is not finite", i, "uvw"[a]);
        if (!copy_numbers(arrays->knot_values[a], count, &spec->list[a]))
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

/* How far the dot products of axes may be from 0 or 1, as in a lattice file. */
#define AXES_TOLERANCE 1e-6

static ffd_status fill_axes(const double axes[9], lattice_spec *spec, ffd_error *error)
{
    for (int i = 0; i < 9; i++) {
        spec->has_axes = spec->has_axes || axes[i] != 0;
        spec->box_axes[i] = axes[i];
    }
    for (int r = 0; r < 3 && !spec->has_axes; r++)
        spec->box_axes[4 * r] = 1;
    for (int r = 0; r < 3; r++)
        for (int s = r; s < 3; s++)
            if (!(fabs(vec_dot(spec->box_axes + 3 * r, spec->box_axes + 3 * s) - (r == s)) <= AXES_TOLERANCE))
                return ffd_fail(error, FFD_E_INVALID, "axes %d and %d are not orthogonal unit vectors", r, s);
    return FFD_OK;
}

static ffd_status fill_box(const ffd_lattice_arrays *arrays, lattice_spec *spec, ffd_error *error)
{
    spec->rest = SPEC_BOX;
    for (int a = 0; a < 3; a++) {
        spec->box_min[a] = arrays->box_min[a];
        spec->box_max[a] = arrays->box_max[a];
        if (!(spec->box_min[a] < spec->box_max[a] && isfinite(spec->box_max[a] - spec->box_min[a])))
            return ffd_fail(error, FFD_E_INVALID, "the box from %s to %s in direction %c has no finite side",
                            ffd_number_text(spec->box_min[a]).text, ffd_number_text(spec->box_max[a]).text,
                            "uvw"[a]);
    }
    return fill_axes(arrays->axes, spec, error);
}

static ffd_status fill_rest(const ffd_lattice_arrays *arrays, lattice_spec *spec, ffd_error *error)
{
    spec->rest = SPEC_POINTS;
    if (!copy_numbers(arrays->rest, 3 * spec->count, &spec->points) ||
        !copy_numbers(arrays->rest_weights, spec->count, &spec->weights))
        return ffd_fail_memory(error);
    for (size_t i = 0; spec->weights && i < spec->count; i++)
        if (!(spec->weights[i] > 0 && isfinite(spec->weights[i])))
            return ffd_fail(error, FFD_E_INVALID,
                            "the weight %s of control point %zu is not positive and finite",
                            ffd_number_text(spec->weights[i]).text, i);
    return arrays->rest ? FFD_OK : fill_box(arrays, spec, error);
}

ffd_status ffd_lattice_from_arrays(const ffd_lattice_arrays *arrays, ffd_lattice **lattice, ffd_error *error)
{
    ffd_lattice_arrays own;
    *lattice = NULL;
    ffd_lattice_arrays_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, arrays, "ffd_lattice_arrays", error));
    lattice_spec *const spec = ffd_alloc_zero(1, sizeof *spec);
    ffd_status status = FFD_OK;
    if (!spec || !(spec->name = ffd_text_copy("")))
        TRY_END(ffd_fail_memory(error));
    TRY_END(fill_shape(&own, spec, error));
    TRY_END(fill_knots(&own, spec, error));
    TRY_END(fill_rest(&own, spec, error));
    TRY_END(ffd_spec_build(spec, NULL, lattice, error));
end:
    if (status)
        ffd_spec_free(spec);
    return status;
}
