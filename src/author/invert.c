/* invert.c - ffd_lattice_invert: rest and deformed volume change places. */
#include "author/made.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <ffd/author.h>
#include <ffd/fold.h>

/* Each place of the deformed volume must come from one place: a fold would give it several. */
static ffd_status refuse_folds(const ffd_lattice *lattice, int threads, ffd_error *error)
{
    ffd_folds folds = {.struct_size = sizeof folds};
    TRY(ffd_folds_find(lattice, threads, &folds, error));
    if (folds.verdict == FFD_FOLDS_UNKNOWN)
        return ffd_fail(error, FFD_E_INVALID,
                        "it is not known whether the lattice folds: %llu cells are not decided",
                        (unsigned long long)folds.unknown_cells);
    const ffd_fold_witness *const w = &folds.witness;
    return folds.verdict == FFD_FOLDS_NONE
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID,
                          "the lattice folds at u,v,w = %.9g, %.9g, %.9g (%.9g, %.9g, %.9g deformed): it has "
                          "no inverse there",
                          w->uvw[0], w->uvw[1], w->uvw[2], w->xyz[0], w->xyz[1], w->xyz[2]);
}

static void exchange(made_lattice *made)
{
    const ffd_lattice *const from = made->from;
    double *const weights = made->weights;
    for (size_t i = 0; i < 3 * from->count; i++) {
        made->points[i] = from->deformed[i];
        made->offsets[i] = 0 - from->difference[i]; /* no zero gets a sign */
    }
    made->weights = made->moved_weights;
    made->moved_weights = weights;
}

ffd_status ffd_lattice_invert(const ffd_lattice *lattice, int threads, ffd_lattice **result, ffd_error *error)
{
    made_lattice made = {0};
    ffd_status status;
    *result = NULL;
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    TRY_END(ffd_made_take_points(&made, error));
    TRY_END(refuse_folds(lattice, threads, error));
    exchange(&made);
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}
