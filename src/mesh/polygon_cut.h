/* polygon_cut.h - cuts polygons into triangles, also concave ones and those that are not quite planar. */
#ifndef FFD_MESH_POLYGON_CUT_H
#define FFD_MESH_POLYGON_CUT_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

/* Scratch memory that grows with the largest polygon. Zeroed: none yet. */
typedef struct polygon_cutter {
    double *plane; /* 2 a corner: the polygon seen against its normal */
    uint32_t *previous, *next;
    uint32_t *reflex, *reflex_slot; /* the reflex corners in any order, and the index of each among them */
    size_t reflex_count;
    size_t plane_capacity, previous_capacity, next_capacity, reflex_capacity, reflex_slot_capacity;
} polygon_cutter;

/* Cuts the polygon with the corners points (3 * count doubles, count at least 3) into count - 2 triangles,
   whose corners are numbers of the polygon's and go round as it does. A convex polygon becomes a fan from its
   first corner; others lose an ear at a time (Meisters, Polygons have ears, 1975). Of polygons that cross
   themselves only the number of triangles is certain, and likewise of those that have many thousands of
   corners and are tangled, so that their ears would take too long to find. Errors: FFD_E_LIMIT, FFD_E_MEMORY.
 */
ffd_status ffd_polygon_cut(polygon_cutter *cutter, const double *points, size_t count, uint32_t *triangles,
                           ffd_error *error);
/* Frees the scratch memory. */
void ffd_polygon_cutter_free(polygon_cutter *cutter);

#endif
