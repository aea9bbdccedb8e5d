#include "embed/locator_border.h"
#include "base/memory/memory.h"
#include <stdatomic.h>

struct locator_border {
    _Atomic(boundary *) made;
};

locator_border *ffd_locator_border_create(void)
{
    locator_border *const kept = ffd_alloc_zero(1, sizeof *kept);
    if (kept)
        atomic_init(&kept->made, NULL);
    return kept;
}

void ffd_locator_border_destroy(locator_border *kept)
{
    if (!kept)
        return;
    boundary *made = atomic_load(&kept->made);
    ffd_boundary_destroy(&made);
    ffd_free(kept);
}

ffd_status ffd_locator_border(const ffd_locator *locator, const boundary **border, ffd_error *error)
{
    boundary *there = atomic_load_explicit(&locator->border->made, memory_order_acquire), *mine = NULL;
    *border = there;
    if (there)
        return FFD_OK;
    TRY(ffd_boundary_create(locator->lattice, &mine, error));
    if (atomic_compare_exchange_strong(&locator->border->made, &there, mine)) {
        *border = mine;
        return FFD_OK;
    }
    ffd_boundary_destroy(&mine); /* another thread has published the same border first */
    *border = there;
    return FFD_OK;
}
