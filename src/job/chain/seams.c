#include "job/chain/seams.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/locator.h"
#include "lattice/border.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <string.h>

/* The displacements of both faces agree if they differ by at most this part of the lattice's diagonal. */
#define AGREEMENT 1e-9

/* Blocks: the index of the first mark for seams. */
#define BLOCK_MARKS 2

ffd_status ffd_seams_find(lattice_chain *chain, ffd_error *error)
{
    size_t capacity = 0;
    for (size_t l = 0; l < chain->count; l++)
        for (int a = 0; a < 3; a++) {
            const chain_link *const link = &chain->links[l];
            if (!ffd_locator_has_seam(link->locator, a) || !ffd_lattice_opens_seam(link->lattice, a))
                continue;
            if (!ffd_grow((void **)&chain->seams, &capacity, chain->seam_count + 1, sizeof *chain->seams))
                return ffd_fail_memory(error);
            chain->seams[chain->seam_count++] = (chain_seam){l, a};
        }
    return FFD_OK;
}

size_t ffd_chain_marked(const lattice_chain *chain)
{
    if (chain->blocks)
        return BLOCK_MARKS + (chain->seam_count ? 3 : 0);
    return chain->count + chain->seam_count;
}

static bool is_of_link_before(const void *seam, const void *link)
{
    return ((const chain_seam *)seam)->link < *(const size_t *)link;
}

/* Returns the index of the first seam of link l or a later link. */
static size_t first_seam(const lattice_chain *chain, size_t l)
{
    return lower_bound(&l, chain->seams, chain->seam_count, sizeof *chain->seams, is_of_link_before);
}

const chain_seam *ffd_chain_seam(const lattice_chain *chain, size_t l, int direction)
{
    for (size_t s = first_seam(chain, l); s < chain->seam_count && chain->seams[s].link == l; s++)
        if (chain->seams[s].direction == direction)
            return &chain->seams[s];
    return NULL;
}

void ffd_seams_mark(const lattice_chain *chain, size_t l, chain_run *run, size_t point, const double uvw[3])
{
    if (!run->kept)
        return;
    for (size_t s = first_seam(chain, l); s < chain->seam_count && chain->seams[s].link == l; s++) {
        const int direction = chain->seams[s].direction;
        const size_t mark = chain->blocks ? BLOCK_MARKS + (size_t)direction : chain->count + s;
        const knot_vector *const knots = &chain->links[l].lattice->knots[direction];
        if (!(uvw[direction] - ffd_knots_first(knots) > ffd_knots_last(knots) - uvw[direction]))
            continue;
        run->kept[ffd_kept_plane(mark) * CHAIN_RUN + point] |= ffd_kept_bit(mark);
        run->keeps = true;
    }
}

double ffd_seam_parting(const lattice_chain *chain, const chain_seam *seam, const double low[3],
                        const double high[3])
{
    const ffd_lattice *const lattice = chain->links[seam->link].lattice;
    const knot_vector *const knots = &lattice->knots[seam->direction];
    double first[3], last[3], by_first[3], by_last[3];
    memcpy(first, low, sizeof first);
    memcpy(last, high, sizeof last);
    first[seam->direction] = ffd_knots_first(knots);
    last[seam->direction] = ffd_knots_last(knots);
    ffd_displacement(lattice, first, by_first, NULL);
    ffd_displacement(lattice, last, by_last, NULL);
    const double difference[3] = {by_last[0] - by_first[0], by_last[1] - by_first[1],
                                  by_last[2] - by_first[2]};
    const double length = vec_length(difference);
    return length > AGREEMENT * lattice->diagonal ? length : 0;
}
