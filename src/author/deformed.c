#include "author/deformed.h"
#include "author/made.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <string.h>

static ffd_status check_positions(const ffd_lattice *lattice, ffd_error *error)
{
    return lattice->rest
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID,
                          "the box of a lattice is that of a mesh, and deformed control points need "
                          "positions ({meshes})");
}

static void take_points(const ffd_lattice *from, made_lattice *made)
{
    const ffd_lattice *const lattice = made->from;
    const bool is_same_rest = memcmp(lattice->rest, from->rest, 3 * from->count * sizeof *from->rest) == 0;
    for (size_t i = 0; i < 3 * from->count; i++)
        made->offsets[i] = is_same_rest ? from->difference[i] : from->deformed[i] - lattice->rest[i];
}

static ffd_status take_weights(const ffd_lattice *from, made_lattice *made, ffd_error *error)
{
    if (!from->rest_weights)
        return FFD_OK;
    TRY(ffd_made_give_weights(made, error));
    memcpy(made->moved_weights, from->deformed_weights, from->count * sizeof *made->moved_weights);
    return FFD_OK;
}

ffd_status ffd_lattice_take_deformed(const ffd_lattice *lattice, const ffd_lattice *from,
                                     ffd_lattice **result, ffd_error *error)
{
    made_lattice made = {0};
    ffd_status status;
    *result = NULL;
    TRY_END(check_positions(lattice, error));
    TRY_END(check_positions(from, error));
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    take_points(from, &made);
    TRY_END(take_weights(from, &made, error));
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}

/* The displacements of a lattice; if it has none, not even zeros, its control points; NULL: it has neither.
 */
static const double *offsets_of(const ffd_lattice *from)
{
    const lattice_spec *const spec = from->spec;
    const bool has_offsets =
        !ffd_lattice_is_still(from) ||
        (spec && (spec->deformed_offsets || spec->deformed_points || spec->move_count > 0));
    if (!from->rest)
        return spec->deformed_offsets;
    return has_offsets ? from->difference : from->rest;
}

ffd_status ffd_lattice_take_offsets(const ffd_lattice *lattice, const ffd_lattice *from, ffd_lattice **result,
                                    ffd_error *error)
{
    made_lattice made = {0}, check = {0};
    const double *const offsets = offsets_of(from);
    ffd_status status;
    *result = NULL;
    TRY_END(ffd_made_begin(from, &check, error)); /* it too needs positions for its moves */
    TRY_END(offsets ? FFD_OK : check_positions(from, error));
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    memcpy(made.offsets, offsets, 3 * from->count * sizeof *made.offsets);
    TRY_END(take_weights(from, &made, error));
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&check);
    ffd_made_free(&made);
    return status;
}
