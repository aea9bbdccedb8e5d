#include "job/chain/look_again.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "embed/near_border.h"
#include <float.h>
#include <math.h>

/* Whether a point may be inside with what it stands for: with twice of that, for the rounding of this test.
 */
static bool is_near(const chain_link *link, const double x[3], const double half[3], double snap)
{
    const bounds *const hull = &link->locator->hull;
    double slack[3];
    for (int a = 0; a < 3; a++)
        slack[a] =
            2 * (half[a] + snap) + 64 * DBL_EPSILON * (fabs(x[a]) + fabs(hull->lo[a]) + fabs(hull->hi[a]));
    return bounds_hold(hull, x, slack);
}

ffd_status ffd_look_again(const chain_link *link, double snap, bool is_first, const chain_run *run,
                          size_t point, const double x[3], ffd_location *location, ffd_error *error)
{
    double half[3] = {0, 0, 0};
    const ffd_border_allowance allowance = {half, snap};
    if (!run->rounding && !(snap > 0))
        return FFD_OK;
    if (run->rounding)
        run->rounding->find(run->rounding->context, point, is_first, x, half);
    if (!is_near(link, x, half, snap))
        return FFD_OK;
    return ffd_near_border_find(link->locator, x, 1, &allowance, location, error);
}
