#include "job/chain/chain_boxes.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include <float.h>
#include <math.h>

/* The bounds of the control points, which hold the volume. */
static bounds rest_bounds(const ffd_lattice *lattice)
{
    bounds box;
    for (int a = 0; a < 3; a++)
        box.lo[a] = box.hi[a] = lattice->rest[a];
    for (size_t i = 1; i < lattice->count; i++)
        bounds_add(&box, lattice->rest + 3 * i);
    return box;
}

bounds ffd_chain_reach(const lattice_chain *chain, size_t link)
{
    const chain_outside *outside = &chain->outside;
    const bool everywhere = outside->extend && !(outside->falloff > 0);
    const double falloff = outside->extend ? outside->falloff : 0;
    const double beyond = everywhere ? HUGE_VAL : larger_of(falloff, chain->links[link].snap);
    bounds box = rest_bounds(chain->links[link].lattice);
    for (int a = 0; a < 3; a++) {
        box.lo[a] -= beyond;
        box.hi[a] += beyond;
    }
    return box;
}

ffd_status ffd_chain_boxes(lattice_chain *chain, ffd_error *error)
{
    if (chain->count < 2)
        return FFD_OK;
    chain->boxes = ffd_alloc(chain->count, sizeof *chain->boxes);
    if (!chain->boxes)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < chain->count; l++) {
        const bounds box = chain->boxes[l] = rest_bounds(chain->links[l].lattice);
        for (int a = 0; a < 3; a++)
            chain->slack[a] = larger_of(chain->slack[a],
                                        chain->links[l].snap +
                                            16 * DBL_EPSILON * larger_of(fabs(box.lo[a]), fabs(box.hi[a])));
    }
    if (chain->blocks && !ffd_box_tree_build(chain->boxes, chain->count, &chain->tree))
        return ffd_fail_memory(error);
    return FFD_OK;
}
