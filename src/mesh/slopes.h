/* slopes.h - how the weights of vertices change along a surface (src/maths.md 9.7). */
#ifndef FFD_MESH_SLOPES_H
#define FFD_MESH_SLOPES_H

#include "base/vector/vec.h"
#include "mesh/mesh.h"
#include "mesh/triangle_kernel.h"
#include <ffd/isa.h>

/* A surface of triangles, whose corners have weights. */
typedef struct weighted_surface {
    const double *positions; /* 3 for each of vertex_count vertices; NULL: read has them */
    const double *weights;   /* one for each vertex; NaN: its triangles do not count */
    size_t vertex_count;
    /* Reads the positions of vertices [first, first + count). Several threads call it at once. */
    void (*read)(const void *surface, size_t first, size_t count, double *positions);
    double largest; /* with read: the greatest magnitude of a finite coordinate */
    /* Passes all triangles to a visitor, always in the same order. Several threads call it at once. */
    ffd_status (*walk)(const void *surface, mesh_triangle_visitor *visit, void *context, ffd_error *error);
    const void *surface; /* passed to read and walk */
    ffd_isa isa;         /* one that is available; does not affect the result */
} weighted_surface;

/* The most temporary bytes of ffd_slopes_find for each vertex. */
#define SLOPE_BYTES (3 * sizeof(double))

/* What the slopes at vertices are made of. */
typedef struct slope_sums {
    double *sums; /* SLOPE_STRIDE numbers of each vertex */
    double scale; /* of lengths in the sums */
} slope_sums;

/* Finds the slopes at all vertices: of a triangle it is the vector g in its plane with g.e1 = w1 - w0 and
   g.e2 = w2 - w0 for its edges e1 and e2 from corner 0; at a position it is the mean over the triangles round
   it, weighted by their areas. With read only some positions are held at a time, if triangles that follow
   each other are near each other by their numbers; else SLOPE_BYTES for each vertex. twins: of
   ffd_positions_twins; NULL: no two vertices share a position. threads: 0: all cores; the result does not
   depend on them. slopes: sums has room for all; filled. *has_triangles: whether there are any; may be NULL.
   Errors: FFD_E_MEMORY, those of the walk and of the deadline. */
ffd_status ffd_slopes_find(const weighted_surface *surface, const uint32_t *twins, int threads,
                           slope_sums *slopes, bool *has_triangles, ffd_error *error);

/* Sets slope to that at a vertex: 0 at a position of no triangle with an area, or where it overflows. */
static inline void ffd_slope_at(const slope_sums *slopes, size_t vertex, double slope[3])
{
    const double *const sum = slopes->sums + SLOPE_STRIDE * vertex;
    const double area = sum[3] > 0 ? sum[3] : 1; /* all are 0 then */
    for (int k = 0; k < 3; k++)
        slope[k] = sum[k] / area * slopes->scale;
    if (!vec_is_finite(slope))
        slope[0] = slope[1] = slope[2] = 0;
}

/* A walk over polygons (a mesh_faces): the triangles from the first corner of each. */
ffd_status ffd_slopes_walk_faces(const void *faces, mesh_triangle_visitor *visit, void *context,
                                 ffd_error *error);

#endif
