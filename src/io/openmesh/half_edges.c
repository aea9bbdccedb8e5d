#include "io/openmesh/half_edges.h"

/* Measured bytes per corner. More than eight corners per vertex mean faces that share few edges: their
   vertices are copied. */
#define SHARING_BYTES 72
#define COPYING_BYTES 120
#define LONGEST_BYTES 64
#define VERTEX_BYTES 16

uint64_t ffd_half_edge_bytes(const mesh_faces *faces)
{
    const uint64_t corners = faces->start[faces->face_count];
    uint64_t longest = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint64_t length = faces->start[f + 1] - faces->start[f];
        longest = length > longest ? length : longest;
    }
    return corners * (corners / 8 > faces->vertex_count ? COPYING_BYTES : SHARING_BYTES) +
           LONGEST_BYTES * longest + VERTEX_BYTES * faces->vertex_count;
}
