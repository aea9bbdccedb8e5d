#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"

void ffd_lattice_destroy(ffd_lattice **lattice)
{
    if (!lattice || !*lattice)
        return;
    ffd_lattice *const l = *lattice;
    if (l->spec)
        ffd_spec_free(l->spec);
    for (int a = 0; a < 3; a++)
        ffd_knots_free(&l->knots[a]);
    ffd_free(l->rest);
    ffd_free(l->deformed);
    ffd_free(l->rest_weights);
    ffd_free(l->deformed_weights);
    ffd_free(l->difference);
    ffd_free(l->moved);
    ffd_free(l);
    *lattice = NULL;
}
