#include "lattice/build.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "lattice/cylinder.h"
#include "lattice/drag.h"
#include "lattice/keys.h"
#include "lattice/lattice.h"
#include "lattice/moves.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Adds the JSON pointer of its cause to an error. */
static ffd_status locate(const lattice_spec *spec, size_t line, const char *pointer, ffd_status status,
                         ffd_error *error)
{
    if (status == FFD_E_INVALID && error && !error->pointer[0])
        return ffd_fail_at(error, status, spec->name, line, pointer, "%s", error->message);
    if (status)
        ffd_fail_name_file(error, spec->name);
    return status;
}

static ffd_status make_knots(const lattice_spec *spec, ffd_lattice *lattice, ffd_error *error)
{
    for (int a = 0; a < 3; a++) {
        char pointer[16];
        snprintf(pointer, sizeof pointer, "/knots/%d", a);
        lattice->size[a] = spec->size[a];
        const ffd_status status = ffd_knots_make(spec->kind[a], spec->degree[a], spec->size[a], spec->list[a],
                                                 spec->list_count[a], "uvw"[a], &lattice -> knots[a], error);
        TRY(locate(spec, spec->knots_line[a], pointer, status, error));
    }
    lattice->count = spec->count;
    return FFD_OK;
}

static ffd_status make_points(ffd_lattice *lattice, ffd_error *error)
{
    lattice->rest = ffd_alloc_whole(lattice->count, 3 * sizeof *lattice->rest);
    lattice->deformed = ffd_alloc_whole(lattice->count, 3 * sizeof *lattice->deformed);
    return lattice->rest && lattice->deformed ? FFD_OK : ffd_fail_memory(error);
}

static bool all_equal(const double *weights, size_t count)
{
    for (size_t i = 1; weights && i < count; i++)
        if (weights[i] != weights[0])
            return false;
    return true;
}

static ffd_status make_weights(const lattice_spec *spec, ffd_lattice *lattice, ffd_error *error)
{
    const double *const rest = spec->weights, *const deformed = spec->deformed_weights;
    const bool rest_is_one = !rest || (all_equal(rest, spec->count) && rest[0] == 1);
    const bool deformed_is_one = !deformed || (all_equal(deformed, spec->count) && deformed[0] == 1);
    /* Keys go between weights, so that all have some where the moves of one make them. */
    if (rest_is_one && deformed_is_one && !(spec->keys.kind == KEYS_POINTS && ffd_spec_has_exact(spec)))
        return FFD_OK;
    lattice->rest_weights = ffd_alloc(spec->count, sizeof *rest);
    lattice->deformed_weights = ffd_alloc(spec->count, sizeof *deformed);
    if (!lattice->rest_weights || !lattice->deformed_weights)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < spec->count; i++) {
        lattice->rest_weights[i] = rest ? rest[i] : 1;
        lattice->deformed_weights[i] = deformed ? deformed[i] : lattice->rest_weights[i];
    }
    return FFD_OK;
}

/* With equal weights and control points at the Greville abscissae the map is affine, and given by the region
   of the box without looking at the points. */
static ffd_status place_box(const lattice_spec *spec, ffd_lattice *lattice, const double min[3],
                            const double max[3], rest_region *region, ffd_error *error)
{
    const ffd_status status =
        ffd_shape_box(lattice, min, max, spec->box_axes, spec->spacing, lattice->rest, error);
    if (status)
        return locate(spec, spec->rest_line, "/rest/box/spacing", status, error);
    ffd_shape_box_region(min, max, spec->box_axes, region);
    if (spec->spacing == FFD_SPACING_GREVILLE && all_equal(lattice->rest_weights, lattice->count)) {
        lattice->form = REST_BOX_AFFINE;
        memcpy(lattice->origin, region->origin, sizeof region->origin);
        memcpy(lattice->frame, region->frame, sizeof region->frame);
    }
    return FFD_OK;
}

static void place_points(const lattice_spec *spec, ffd_lattice *lattice, rest_region *region)
{
    memcpy(lattice->rest, spec->points, spec->count * 3 * sizeof *spec->points);
    for (int c = 0; c < 3; c++) {
        double min = spec->points[c], max = min;
        for (size_t i = 1; i < spec->count; i++) {
            min = minimum_number(min, spec->points[3 * i + c]);
            max = maximum_number(max, spec->points[3 * i + c]);
        }
        region->origin[c] = min;
        for (int a = 0; a < 3; a++)
            region->frame[3 * c + a] = a == c ? max - min : 0;
    }
}

/* A side in which the mesh is flat counts as widened, as that of its box without margin. */
static ffd_status make_mesh_region(const fit_extent *extent, rest_region *region, ffd_error *error)
{
    static const double none[3] = {0, 0, 0}, axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double min[3], max[3];
    TRY(ffd_shape_grow_box(extent->shown_min, extent->shown_max, none, min, max, error));
    ffd_shape_box_region(min, max, axes, region);
    return FFD_OK;
}

static ffd_status place_rest(const lattice_spec *spec, const fit_extent *extent, ffd_lattice *lattice,
                             rest_region *region, ffd_error *error)
{
    double grown_min[3], grown_max[3];
    ffd_status status;
    lattice->form = REST_POINTS;
    switch (spec->rest) {
    case SPEC_BOX:
        return place_box(spec, lattice, spec->box_min, spec->box_max, region, error);
    case SPEC_BOX_MESH:
        status = ffd_shape_grow_box(extent->min, extent->max, spec->margin, grown_min, grown_max, error);
        if (status)
            return locate(spec, spec->rest_line, "/rest/box", status, error);
        TRY(place_box(spec, lattice, grown_min, grown_max, region, error));
        return spec->units == UNITS_MESH ? make_mesh_region(extent, region, error) : FFD_OK;
    case SPEC_CYLINDER:
        ffd_shape_cylinder_region(spec, region);
        return locate(spec, spec->rest_line, "/rest/cylinder",
                      ffd_shape_cylinder(lattice, spec, lattice->rest, error), error);
    case SPEC_POINTS:
        place_points(spec, lattice, region);
        break;
    }
    return FFD_OK;
}

/* Sets the deformed control points before the moves. Offsets are stored as displacements directly: (P + D) -
   P would lose their last digits, and give points with offset 0 a displacement. */
static ffd_status set_deformed(const lattice_spec *spec, ffd_lattice *lattice, ffd_error *error)
{
    const size_t size = spec->count * 3 * sizeof *lattice->deformed;
    memcpy(lattice->deformed, spec->deformed_points ? spec->deformed_points : lattice->rest, size);
    TRY(ffd_lattice_make_difference(lattice, error));
    if (!spec->deformed_offsets)
        return FFD_OK;
    memcpy(lattice->difference, spec->deformed_offsets, size);
    for (size_t c = 0; c < 3 * spec->count; c++)
        lattice->deformed[c] = lattice->rest[c] + spec->deformed_offsets[c];
    return FFD_OK;
}

static ffd_status set_points(const lattice_spec *spec, const fit_extent *extent,
                             const move_observer *observer, ffd_lattice *lattice, ffd_error *error)
{
    rest_region region;
    TRY(make_points(lattice, error));
    TRY(make_weights(spec, lattice, error));
    TRY(place_rest(spec, extent, lattice, &region, error));
    TRY(set_deformed(spec, lattice, error));
    if (spec->move_count > 0)
        TRY(ffd_moves_apply(spec, &region, lattice, observer, error));
    if (spec->keys.kind == KEYS_POINTS && spec->open.count == 0)
        TRY(ffd_keys_apply(spec, &region, lattice, error));
    return ffd_lattice_finish_moved(lattice, error);
}

static ffd_status build(lattice_spec *spec, const fit_extent *extent, bool points,
                        const move_observer *observer, ffd_lattice **lattice, ffd_error *error)
{
    *lattice = NULL;
    ffd_lattice *result = ffd_alloc_zero(1, sizeof *result);
    ffd_status status;
    TRY_END(result ? make_knots(spec, result, error) : ffd_fail_memory(error));
    if (points)
        TRY_END(set_points(spec, extent, observer, result, error));
end:
    if (status) {
        ffd_fail_name_file(error, spec->name);
        ffd_lattice_destroy(&result);
        return status;
    }
    result->spec = spec;
    if (extent)
        result->fitted = *extent;
    *lattice = result;
    return FFD_OK;
}

ffd_status ffd_spec_build(lattice_spec *spec, const fit_extent *extent, ffd_lattice **lattice,
                          ffd_error *error)
{
    return build(spec, extent, spec->rest != SPEC_BOX_MESH || extent, NULL, lattice, error);
}

ffd_status ffd_lattice_replay(const ffd_lattice *lattice, const move_observer *observer, ffd_error *error)
{
    const bool fitted = lattice->spec->rest == SPEC_BOX_MESH;
    ffd_lattice *again;
    TRY(build(lattice->spec, fitted ? &lattice->fitted : NULL, true, observer, &again, error));
    again->spec = NULL; /* it belongs to the lattice */
    ffd_lattice_destroy(&again);
    return FFD_OK;
}

ffd_status ffd_spec_build_knots(lattice_spec *spec, ffd_lattice **lattice, ffd_error *error)
{
    return build(spec, NULL, false, NULL, lattice, error);
}

uint64_t ffd_spec_knot_bytes(const lattice_spec *spec)
{
    uint64_t bytes = 0;
    for (int a = 0; a < 3; a++) {
        const uint64_t order = (uint64_t)spec->degree[a] + 1;
        /* Knots of the lattice and of the locator, the indices of the spans, and their Bezier extractions. */
        const uint64_t each = 2 * sizeof(double) + sizeof(int) + order * order * sizeof(double);
        bytes += (spec->size[a] + 2 * order) * each + spec->list_count[a] * sizeof(double);
    }
    return bytes;
}

/* The bytes that the largest drag takes while it is applied. */
static uint64_t drag_bytes(const lattice_spec *spec)
{
    uint64_t most = 0, acting = 1;
    for (int a = 0; a < 3; a++)
        acting *= (uint64_t)spec->degree[a] + 1;
    for (size_t list = 0; list <= spec->keys.count; list++) {
        size_t count;
        const lattice_move *const moves = ffd_spec_moves(spec, list, &count);
        for (size_t i = 0; i < count; i++) {
            const uint64_t bytes =
                ffd_drag_bytes(moves[i].drag_count * (moves[i].mirror.kind == MIRROR_NONE ? 1 : 2), acting);
            most = bytes > most ? bytes : most;
        }
    }
    return most;
}

/* The bytes of a control point in the keys of the spec, and of what they need to go between two. */
static uint64_t key_bytes(const lattice_spec *spec)
{
    uint64_t each = spec->keys.kind == KEYS_POINTS ? 7 * sizeof(double) : 0;
    for (size_t k = 0; k < spec->keys.count; k++)
        each += spec->keys.list[k].offsets ? 3 * sizeof(double) : 0;
    return each;
}

uint64_t ffd_spec_point_bytes(const lattice_spec *spec)
{
    uint64_t each = 3 * 3 * sizeof(double) + 1; /* rest, deformed, difference, moved */
    each += spec->weights || spec->deformed_weights || ffd_spec_has_exact(spec) ? 2 * sizeof(double) : 0;
    /* Two trees while the moves are applied. */
    each += ffd_spec_finds_images(spec) ? 2 * (sizeof(uint32_t) + 1) : 0;
    each += spec->points ? 3 * sizeof(double) : 0;
    each += spec->deformed_points || spec->deformed_offsets ? 3 * sizeof(double) : 0;
    each += spec->weights ? sizeof(double) : 0;
    each += spec->deformed_weights ? sizeof(double) : 0;
    each += key_bytes(spec);
    return spec->count * each + drag_bytes(spec);
}
