/* meshopt_filters.h - the filters of KHR_meshopt_compression (its appendix B). We do not use those of the
   library, because approximate reciprocals and fused operations make its results depend on the processor. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_FILTERS_H
#define FFD_MESH_MESHOPT_MESHOPT_FILTERS_H

#include <stddef.h>
#include <stdint.h>

/* Filter 1: decodes count elements of stride bytes (4: 8 bits for each component, 8: 16 bits), in place.
   Elements that are not a direction become 0. */
void ffd_meshopt_unfold(unsigned char *bytes, size_t count, size_t stride);
/* Filter 2: decodes count quaternions of 8 bytes, in place. */
void ffd_meshopt_complete_rotations(unsigned char *bytes, size_t count);
/* Filter 3: decodes count elements of stride bytes, floats with an exponent in the highest byte and a
   mantissa in the others, in place. */
void ffd_meshopt_scale(unsigned char *bytes, size_t count, size_t stride);
/* Finds the least exponent of each of the stride / 4 numbers of an element, zeros ignored, before they are
   scaled. INT8_MIN: all are 0. */
void ffd_meshopt_find_exponents(const unsigned char *bytes, size_t count, size_t stride, int8_t *exponents);
/* Filter 4: decodes count colours of stride bytes (4: 8 bits for each component, 8: 16 bits), in place.
   Elements that do not tell their scale become 0. */
void ffd_meshopt_mix_colors(unsigned char *bytes, size_t count, size_t stride);

#endif
