/* point_cells.h - the embedded points by span cell, in the order in which many variants are computed. */
#ifndef FFD_POINTS_POINT_CELLS_H
#define FFD_POINTS_POINT_CELLS_H

#include "points/embedding.h"

typedef struct point_cells point_cells;

/* A cell that has points. */
typedef struct point_cell {
    size_t index[3];     /* among the spans that are not empty */
    size_t first, count; /* its points */
    bool has_knots;      /* a point is on a knot */
} point_cell;

/* All points that have u,v,w, or those of their nearest border point. */
struct point_cells {
    point_cell
        *cells; /* in ascending order of u, then v, then w, so that those of a column follow each other */
    size_t cell_count, count;
    uint32_t *which;  /* the index of each point, cell by cell */
    double *uvw;      /* 3 numbers for each, in the domain */
    double *fade;     /* the factor of each displacement (src/maths.md 8.2); NULL: all are 1 */
    uint32_t *others; /* the points that have none, ascending */
    size_t other_count;
};

/* Returns the sorted points of an embedding, which has them from the first call on. NULL if memory runs out.
   Thread-safe. */
const point_cells *ffd_point_cells(const ffd_embedding *embedding);
/* Returns whether a call for which they are of use, but not needed, should ask for them: they are there, or
   this is not the first such call. To sort points takes as long as to deform them a few times. Thread-safe.
 */
bool ffd_point_cells_pay(const ffd_embedding *embedding);

#endif
