#include "job/chain/look_again.h"
#include "embed/near_border.h"

ffd_status ffd_look_again(const chain_link *link, double snap, bool is_first, const chain_run *run,
                          size_t point, const double x[3], ffd_location *location, ffd_error *error)
{
    double half[3] = {0, 0, 0};
    if (!run->rounding && !(snap > 0))
        return FFD_OK;
    if (run->rounding)
        run->rounding->find(run->rounding->context, point, is_first, x, half);
    return ffd_near_border_look_again(link->locator, x, half, snap, location, error);
}
