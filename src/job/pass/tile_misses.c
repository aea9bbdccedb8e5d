/* tile_misses.c - how many vertices of a tile miss the lattice by very little. */
#include "job/chain/point_rounding.h"
#include "job/pass/tile.h"
#include "lattice/lattice.h"

/* A miss by this part of the rest lattice's diagonal is worth a word: the digits of a text, mostly. */
#define NEXT_TO_NOTHING 1e-5
/* The most searches of the border in a tile, */
#define MOST_SEARCHES 64
/* and if none of so many vertices is near. */
#define FEW_SEARCHES 8

ffd_status ffd_tile_find_misses(const pass_tile *tile, ffd_error *error)
{
    const tile_points *const base = &tile->scratch->base;
    const lattice_chain *const chain = tile->pass->chain;
    const chain_link *const link = chain->links;
    near_misses *const misses = &tile->totals->misses;
    const uint64_t before = misses->count;
    int searches = 0;
    if (chain->count != 1 || tile->pass->links != 1 || chain->outside.extend)
        return FFD_OK;
    const double reach = NEXT_TO_NOTHING * link->lattice->diagonal;
    for (size_t i = 0; i < base->count; i++) {
        double miss;
        bool searched;
        if (base->outcomes[i].status != FFD_VERTEX_OUTSIDE ||
            !ffd_part_shows(tile->part, tile->first + ffd_tile_vertex(base, i)))
            continue;
        TRY(ffd_link_miss(link, base->position + 3 * i, reach, &miss, &searched, error));
        misses->examined++;
        misses->count += miss > 0 && isfinite(miss);
        if (isfinite(miss))
            misses->largest = larger_of(misses->largest, miss);
        searches += searched;
        misses->is_least = searches == MOST_SEARCHES || (searches == FEW_SEARCHES && misses->count == before);
        if (misses->is_least)
            break;
    }
    return FFD_OK;
}
