/* tolerance_image.h - a region and the image of the tolerance in it: the parallelepiped of all t that the
   contraction allows for a root (src/maths.md 6.5). Where coordinates are known with very different accuracy,
   it is long and thin, and its shape tells more than its size. */
#ifndef FFD_EMBED_CELLS_TOLERANCE_IMAGE_H
#define FFD_EMBED_CELLS_TOLERANCE_IMAGE_H

#include "embed/cells/point_search.h"

typedef struct tolerance_view {
    bool misses; /* proven: no point of the region meets the tolerance */
    double blur; /* the least width of the image, in widths of the region across the same planes */
} tolerance_view;

/* Tests the planes that can separate the region from the image. region->centre must be set; box is the Bezier
   form of the region. */
tolerance_view ffd_tolerance_view(const point_search *search, const cell_region *region,
                                  const bezier_box *box);

/* Finds a root near t, in the part of the region that the image covers. Returns whether there is one: then t
   meets the tolerance, and *at is its sample. */
bool ffd_tolerance_find(point_search *search, const cell_region *region, double t[3], sample *at);

#endif
