/* meshopt_filters.h - the filters of KHR_meshopt_compression that make unit vectors and rotations of
   integers. In our own code: the library's uses approximate reciprocals and fused operations where a
   processor has them, so that it gives other integers on other processors. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_FILTERS_H
#define FFD_MESH_MESHOPT_MESHOPT_FILTERS_H

#include <stddef.h>

/* Decodes count elements of stride bytes (4: of 8 bits a component, 8: of 16) in place, filter 1. Components
   that name no direction become 0. */
void ffd_meshopt_unfold(unsigned char *bytes, size_t count, size_t stride);
/* Decodes count quaternions of 8 bytes in place, filter 2. */
void ffd_meshopt_complete_rotations(unsigned char *bytes, size_t count);

#endif
