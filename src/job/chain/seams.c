#include "job/chain/seams.h"
#include "base/memory/memory.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "lattice/border.h"
#include "lattice/lattice.h"
#include <math.h>

ffd_status ffd_seams_find(lattice_chain *chain, ffd_error *error)
{
    size_t capacity = 0;
    for (size_t l = 0; l < chain->count; l++) {
        chain_link *const link = &chain->links[l];
        link->is_convex = link->locator->method != METHOD_GENERAL;
        link->is_still = ffd_lattice_is_still(ffd_link_mover(link));
        link->opens_axis = !link->is_convex && ffd_lattice_opens_axis(ffd_link_mover(link));
        for (int a = 0; a < 3; a++) {
            if (!ffd_locator_has_seam(link->locator, a) || !ffd_lattice_opens_seam(ffd_link_mover(link), a))
                continue;
            if (!ffd_grow((void **)&chain->seams, &capacity, chain->seam_count + 1, sizeof *chain->seams))
                return ffd_fail_memory(error);
            chain->seams[chain->seam_count++] = (chain_seam){l, a};
        }
    }
    return FFD_OK;
}

bool ffd_seams_part(const lattice_chain *chain, size_t l, const double a[3], const double b[3])
{
    for (size_t s = 0; s < chain->seam_count; s++) {
        const int direction = chain->seams[s].direction;
        const knot_vector *const knots = &chain->links[l].lattice->knots[direction];
        if (chain->seams[s].link == l &&
            fabs(a[direction] - b[direction]) > (ffd_knots_last(knots) - ffd_knots_first(knots)) / 2)
            return true;
    }
    return false;
}
