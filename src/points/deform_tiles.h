/* deform_tiles.h - adds displacements to arrays of points, tile by tile: reading and writing, weights, the
   bits of points that stay. What computes the displacements is the caller's. */
#ifndef FFD_POINTS_DEFORM_TILES_H
#define FFD_POINTS_DEFORM_TILES_H

#include "points/point_run.h"

/* What is deformed, and where the results go. All arrays are of all points. */
typedef struct deform_arrays {
    size_t all;               /* points */
    const uint8_t *status;    /* ffd_vertex_status of each */
    const uint32_t *vertices; /* those to be deformed, count of them; NULL: all */
    size_t count;
    bool is_weighted;
    const double *weights, *slopes; /* slopes NULL: all are 0 */
    ffd_span in, out;
    double *gradients; /* or NULL */
} deform_arrays;

/* A tile: points [first, first + count) of those that are deformed. */
typedef struct deform_tile {
    const deform_arrays *arrays;
    size_t first, count;
    const double *x;  /* 3 a point: at rest */
    double *delta;    /* 3: to be filled */
    double *gradient; /* 9: to be filled; NULL: not wanted */
} deform_tile;

/* Returns the index of point i of a tile among all. */
static inline size_t ffd_tile_point(const deform_tile *tile, size_t i)
{
    return tile->arrays->vertices ? tile->arrays->vertices[tile->first + i] : tile->first + i;
}

/* Computes the displacements of a tile. */
typedef ffd_status (*displace_function)(void *context, const deform_tile *tile, int worker, ffd_error *error);

/* Checks the arrays, and fills in the default steps of the spans. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (a
   weight). */
ffd_status ffd_deform_check(deform_arrays *arrays, ffd_error *error);
/* Deforms the points of a run over arrays->count points. Errors: FFD_E_INVALID (a result is too large for the
   type of out), FFD_E_CANCELLED, FFD_E_MEMORY, and those of displace. */
ffd_status ffd_deform_tiles(point_run *run, const deform_arrays *arrays, displace_function displace,
                            void *context, ffd_error *error);

#endif
