/* weights.h - the weights of points (public functions: ffd/points.h). */
#ifndef FFD_POINTS_WEIGHTS_H
#define FFD_POINTS_WEIGHTS_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

/* Checks that weights are numbers from 0 to 1: those of the listed points, or of the first `count` where the
   list is NULL. Errors: FFD_E_ARGUMENT (there are none), FFD_E_INVALID. */
ffd_status ffd_weights_check(const double *weights, const uint32_t *list, size_t count, ffd_error *error);

#endif
