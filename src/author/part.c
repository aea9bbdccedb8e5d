#include "author/part.h"
#include "author/made.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <string.h>

/* Makes what is deformed the rest. */
static ffd_status keep_deformed(made_lattice *made, ffd_error *error)
{
    TRY(ffd_made_take_points(made, error));
    memcpy(made->points, made->from->deformed, 3 * made->from->count * sizeof *made->points);
    if (made->moved_weights)
        memcpy(made->weights, made->moved_weights, made->from->count * sizeof *made->weights);
    return FFD_OK;
}

ffd_status ffd_lattice_take_part(const ffd_lattice *lattice, ffd_lattice_part part, ffd_lattice **result,
                                 ffd_error *error)
{
    made_lattice made = {0};
    ffd_status status;
    *result = NULL;
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    if (part == FFD_PART_DEFORMED && !ffd_lattice_is_still(lattice))
        TRY_END(keep_deformed(&made, error));
    if (part == FFD_PART_REST || part == FFD_PART_DEFORMED) {
        ffd_free(made.offsets);
        ffd_free(made.moved_weights);
        made.offsets = made.moved_weights = NULL;
    }
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}
