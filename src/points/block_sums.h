/* block_sums.h - sums over many points that do not depend on the number of threads: they are formed in blocks
   of POINT_TILE points, which are added in their order. */
#ifndef FFD_POINTS_BLOCK_SUMS_H
#define FFD_POINTS_BLOCK_SUMS_H

#include "points/point_run.h"

/* Adds points [first, last) to sum, which has as many numbers as the whole. */
typedef void (*block_sum_function)(void *context, size_t first, size_t last, int worker, double *sum);

/* Fills sum with the sums over all points of a run, width > 0 numbers. Errors: FFD_E_CANCELLED,
   FFD_E_MEMORY. */
ffd_status ffd_block_sums(const point_run *run, size_t width, block_sum_function function, void *context,
                          double *sum, ffd_error *error);

#endif
