/* raster.h - rasterises triangles to samples. Coverage uses integers only: a sample on an edge that two
   triangles share belongs to exactly one of them. ffd_raster_triangle is in raster_triangle.c. */
#ifndef FFD_PICTURE_RASTER_H
#define FFD_PICTURE_RASTER_H

#include "picture/samples.h"
#include "picture/shade.h"

/* A corner in subpixels. */
typedef struct raster_corner {
    int32_t x, y;
    float z;
} raster_corner;

/* Finds the rows in which a triangle of a surface may have samples. Returns false if there are none, or if
   the triangle repeats a preceding one. (A band_rows callback.) */
bool ffd_raster_rows(const void *surface, size_t triangle, int64_t *first, int64_t *last);
/* Draws a triangle into samples where it is nearer than the stored depth. */
void ffd_raster_triangle(const surface *of, const linear_tables *tables, size_t triangle, samples *into);
/* Draws three corners as a part of a triangle. is_flat: with a single colour. */
void ffd_raster_corners(const surface *of, const linear_tables *tables, size_t triangle,
                        const raster_corner corners[3], bool is_flat, samples *into);

#endif
