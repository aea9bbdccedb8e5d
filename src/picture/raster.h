/* raster.h - triangles to samples. A sample belongs to a triangle by integers alone: one on an edge that two
   triangles share belongs to just one of them. raster_triangle.c has
   ffd_raster_triangle. */
#ifndef FFD_PICTURE_RASTER_H
#define FFD_PICTURE_RASTER_H

#include "picture/samples.h"
#include "picture/shade.h"

/* A corner in parts of a pixel. */
typedef struct raster_corner {
    int32_t x, y;
    float z;
} raster_corner;

/* The rows that a triangle of a surface may have samples in. Returns false where it has none, or none that an
   equal triangle before it has not. (A band_rows.) */
bool ffd_raster_rows(const void *surface, size_t triangle, int64_t *first, int64_t *last);
/* Draws a triangle into samples: where it is nearer than what is there. */
void ffd_raster_triangle(const surface *of, const linear_tables *tables, size_t triangle, samples *into);
/* Draws three corners as a part of a triangle, of one colour where is_flat. */
void ffd_raster_corners(const surface *of, const linear_tables *tables, size_t triangle,
                        const raster_corner corners[3], bool is_flat, samples *into);

#endif
