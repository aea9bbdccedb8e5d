#include "job/chain/point_rounding.h"
#include "embed/acceptance.h"
#include "embed/near_border.h"

ffd_status ffd_retry_near_border(const chain_link *link, double snap, bool is_first, const chain_run *run,
                                 size_t point, const double x[3], ffd_location *location, ffd_error *error)
{
    double half[3];
    if (!run->rounding && !(snap > 0))
        return FFD_OK;
    ffd_rounding_find(run->rounding, point, is_first, x, half);
    return ffd_near_border_retry(link->locator, x, half, snap, location, error);
}

ffd_status ffd_link_miss(const chain_link *link, const double x[3], double reach, double *miss,
                         bool *searched, ffd_error *error)
{
    return ffd_near_border_miss(link->locator, x, reach, miss, searched, error);
}

bool ffd_recalled_meets(const chain_link *link, const chain_rounding *rounding, size_t point,
                        const double x[3], const ffd_location *location)
{
    double half[3];
    if ((location->status != FFD_VERTEX_INSIDE && location->status != FFD_VERTEX_MULTIPLE) ||
        ffd_locator_accepts(link->locator, x, location, NULL, 0))
        return true;
    ffd_rounding_find(rounding, point, true, x, half);
    return ffd_locator_accepts(link->locator, x, location, half, link->snap);
}
