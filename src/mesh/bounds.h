/* bounds.h - axis-aligned bounding boxes. */
#ifndef FFD_MESH_BOUNDS_H
#define FFD_MESH_BOUNDS_H

#include "base/vector/vec.h"
#include <ffd/job.h>

/* Returns empty bounds, with min greater than max. */
static inline ffd_bounds ffd_bounds_empty(void)
{
    return (ffd_bounds){.min = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .max = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
}

/* Extends the bounds by a point. Coordinates that are NaN are ignored. */
static inline void ffd_bounds_widen(ffd_bounds *box, const double point[3])
{
    for (int a = 0; a < 3; a++) {
        box->min[a] = lesser_of(box->min[a], point[a]);
        box->max[a] = larger_of(box->max[a], point[a]);
    }
}

/* Extends the bounds by others. Empty ones add nothing. */
static inline void ffd_bounds_join(ffd_bounds *box, const ffd_bounds *other)
{
    for (int a = 0; a < 3; a++) {
        box->min[a] = lesser_of(box->min[a], other->min[a]);
        box->max[a] = larger_of(box->max[a], other->max[a]);
    }
}

#endif
