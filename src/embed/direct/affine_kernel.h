/* affine_kernel.h - u,v,w of an affine rest map for several points at a time, one in each lane. */
#ifndef FFD_EMBED_DIRECT_AFFINE_KERNEL_H
#define FFD_EMBED_DIRECT_AFFINE_KERNEL_H

#include "base/vector/isa.h"
#include "embed/frame/frame.h"

/* The most points of a call. */
#define AFFINE_POINTS ((size_t)256)

/* Finds u,v,w of those of count points (xyz as in ffd_locator_find) for which the inverse matrix alone gives
   a result in the domain and within the tolerance, with the same bits as ffd_affine_find: 3 numbers each, and
   the residual. found: one byte for each point; 0: call ffd_affine_find. One function for each SIMD
   instruction set. */
typedef void affine_kernel(const ffd_locator *locator, const double *xyz, size_t count, double *uvw,
                           double *residuals, uint8_t *found);

#define DECLARE(ISA, set, lanes) affine_kernel ffd_affine_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
