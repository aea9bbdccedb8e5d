/* meshopt_filters.h - the filters of KHR_meshopt_compression that decode unit vectors and rotations from
   integers. We do not use those of the library, because approximate reciprocals and fused operations make its
   results depend on the processor. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_FILTERS_H
#define FFD_MESH_MESHOPT_MESHOPT_FILTERS_H

#include <stddef.h>

/* Filter 1: decodes count elements of stride bytes (4: 8 bits for each component, 8: 16 bits), in place.
   Elements that are not a direction become 0. */
void ffd_meshopt_unfold(unsigned char *bytes, size_t count, size_t stride);
/* Filter 2: decodes count quaternions of 8 bytes, in place. */
void ffd_meshopt_complete_rotations(unsigned char *bytes, size_t count);

#endif
