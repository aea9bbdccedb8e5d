/* locations.h - compares what searches return by its members: padding between them has no value. Includes
 * come after cmocka.h. */
#ifndef FFD_TESTS_LOCATIONS_H
#define FFD_TESTS_LOCATIONS_H

#include "embed/boundary/boundary.h"
#include "ffd/embedding.h"
#include <string.h>

/* Compares bits: NaN equals NaN. */
static inline bool same_locations(const ffd_location *a, const ffd_location *b)
{
    return memcmp(a->uvw, b->uvw, sizeof a->uvw) == 0 &&
           memcmp(&a->residual, &b->residual, sizeof a->residual) == 0 && a->status == b->status &&
           a->unresolved == b->unresolved && a->evaluations == b->evaluations && a->leaves == b->leaves;
}

static inline bool same_border_points(const boundary_point *a, const boundary_point *b)
{
    return a->found == b->found && a->cut_short == b->cut_short &&
           memcmp(a->uvw, b->uvw, sizeof a->uvw) == 0 &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
           memcmp(a->uvw_by_p, b->uvw_by_p, sizeof a->uvw_by_p) == 0;
}

#endif
