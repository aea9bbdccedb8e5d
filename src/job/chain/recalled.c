#include "job/chain/recalled.h"
#include "embed/acceptance.h"

bool ffd_recalled_meets(const chain_link *link, const chain_rounding *rounding, size_t point,
                        const double x[3], const ffd_location *location)
{
    double half[3] = {0, 0, 0};
    if ((location->status != FFD_INSIDE && location->status != FFD_MULTIPLE) ||
        ffd_locator_accepts(link->locator, x, location, NULL, 0))
        return true;
    if (rounding)
        rounding->find(rounding->context, point, true, x, half);
    return ffd_locator_accepts(link->locator, x, location, half, link->snap);
}
