#include "job/pass/tile_misses.h"
#include "job/chain/point_rounding.h"
#include "lattice/lattice.h"

/* A miss by this part of the rest lattice's diagonal is worth a word: the digits of a text, mostly. */
#define NEXT_TO_NOTHING 1e-5
/* The most searches of the border in a tile, */
#define MOST_SEARCHES 64
/* and if none of so many vertices is near. */
#define FEW_SEARCHES 8

ffd_status ffd_tile_find_misses(const part_work *work, const tile_scratch *scratch, size_t first,
                                near_misses *misses, ffd_error *error)
{
    const lattice_chain *const chain = work->pass->chain;
    const chain_link *const link = chain->links;
    ffd_status status = FFD_OK;
    const uint64_t before = misses->count;
    int searches = 0;
    if (chain->count != 1 || work->pass->links != 1 || chain->outside.extend)
        return FFD_OK;
    const double reach = NEXT_TO_NOTHING * link->lattice->diagonal;
    for (size_t i = 0; i < scratch->chosen_count && !status; i++) {
        double miss;
        bool searched;
        if (scratch->point_outcomes[i].status != FFD_OUTSIDE ||
            !ffd_part_shows(work->part, first + ffd_tile_chosen(scratch, i)))
            continue;
        status = ffd_link_miss(link, scratch->position + 3 * i, reach, &miss, &searched, error);
        misses->looked_at++;
        misses->count += miss > 0 && isfinite(miss);
        if (isfinite(miss))
            misses->largest = larger_of(misses->largest, miss);
        searches += searched;
        misses->is_least = searches == MOST_SEARCHES || (searches == FEW_SEARCHES && misses->count == before);
        if (misses->is_least)
            break;
    }
    return status;
}
