/* affine_kernel.h - u,v,w of an affine rest map for several points at a time, each in a lane. */
#ifndef FFD_EMBED_DIRECT_AFFINE_KERNEL_H
#define FFD_EMBED_DIRECT_AFFINE_KERNEL_H

#include "embed/frame/frame.h"

/* Most points at once. */
#define AFFINE_POINTS ((size_t)256)

/* Finds those of count points (as ffd_locator_find has them) that the inverse matrix alone brings into the
   domain and within the tolerance, with the bits of ffd_affine_find. found: one a point; where it is 0,
   ffd_affine_find must. One function for each instruction set that has lanes. */
typedef void affine_kernel(const ffd_locator *locator, const double *xyz, size_t count,
                           ffd_location *locations, uint8_t *found);

#ifdef FFD_X86
affine_kernel ffd_affine_kernel_sse2, ffd_affine_kernel_avx2, ffd_affine_kernel_avx512;
#endif

#endif
