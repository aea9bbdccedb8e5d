#include "lattice/file/spec_still.h"
#include "base/memory/memory.h"
#include "lattice/keys.h"
#include <string.h>

/* Whether the deformed weights have to be written: those at rest times a factor too, though these move
   nothing. */
static bool weights_differ(const ffd_lattice *lattice)
{
    const double *const rest = lattice->rest_weights;
    return rest && memcmp(rest, lattice->deformed_weights, lattice->count * sizeof *rest) != 0;
}

static void drop_moves(lattice_spec *spec)
{
    spec->moves = NULL;
    spec->move_count = 0;
    spec->keys = (spec_keys){0};
}

void ffd_spec_bake(const ffd_lattice *lattice, lattice_spec *spec)
{
    drop_moves(spec);
    spec->open = (intern_table){0};
    spec->deformed_points = NULL;
    spec->deformed_offsets = lattice->difference;
    spec->deformed_weights = weights_differ(lattice) ? lattice->deformed_weights : NULL;
}

/* Offsets need no positions, moves do between two keys. */
static ffd_status still_without_positions(lattice_spec *spec, double **own, ffd_error *error)
{
    const key_place place = ffd_keys_find(&spec->keys);
    const spec_key *const from = &spec->keys.list[place.first], *const to = from + (place.part > 0);
    const size_t count = 3 * spec->count;
    if (from != to && !(from->offsets && to->offsets))
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and between its keys the moves need "
                        "positions");
    drop_moves(spec);
    if (!from->offsets) {
        spec->moves = from->moves;
        spec->move_count = from->move_count;
        return FFD_OK;
    }
    *own = ffd_alloc_whole(count, sizeof **own);
    if (!*own)
        return ffd_fail_memory(error);
    for (size_t c = 0; c < count; c++)
        (*own)[c] = ffd_keys_mix(place.part, from->offsets[c], to->offsets[c]);
    spec->deformed_points = NULL;
    spec->deformed_offsets = *own;
    return FFD_OK;
}

ffd_status ffd_spec_still(const ffd_lattice *lattice, lattice_spec *spec, double **own, ffd_error *error)
{
    *own = NULL;
    if (spec->keys.kind == KEYS_VALUES)
        spec->keys = (spec_keys){0};
    else if (lattice->rest)
        ffd_spec_bake(lattice, spec);
    else if (spec->open.count == 0)
        return still_without_positions(spec, own, error);
    return FFD_OK;
}
