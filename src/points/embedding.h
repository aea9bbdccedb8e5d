/* embedding.h - the struct behind ffd_embedding (public functions: ffd/points.h). Declares functions of
   affected.c and point_cells.c too. */
#ifndef FFD_POINTS_EMBEDDING_H
#define FFD_POINTS_EMBEDDING_H

#include "base/memory/hash.h"
#include "embed/boundary/boundary.h"
#include "lattice/lattice.h"
#include <ffd/points.h>
#include <stdatomic.h>

/* A point without u,v,w that gets the displacement of its nearest border point. */
typedef struct extended_point {
    size_t point;
    boundary_point nearest;
} extended_point;

struct point_cells;

struct ffd_embedding {
    ffd_lattice *rest; /* a copy */
    hash128 rest_hash;
    size_t count;
    double *uvw;     /* 3 for each point */
    uint8_t *status; /* one for each point */
    double falloff;
    extended_point *extended; /* extended_count entries, sorted by point */
    size_t extended_count;
    struct cell_index *index;             /* the points of each span cell, made on first use (affected.c) */
    _Atomic(struct point_cells *) sorted; /* the points cell by cell, likewise (point_cells.h) */
    atomic_bool asked;                    /* whether these would have been of use (point_cells.h) */
};

/* Checks a description, and fills in the default steps of its points. Errors: FFD_E_ARGUMENT, FFD_E_LIMIT. */
ffd_status ffd_embedding_desc_check(ffd_embedding_desc *desc, ffd_error *error);

/* Makes an embedding with a copy of the lattice and with uninitialised arrays for count points. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_embedding_make(const ffd_lattice *lattice, size_t count, ffd_embedding **embedding,
                              ffd_error *error);

/* Returns whether a point has u,v,w. */
static inline bool ffd_embedding_has(const ffd_embedding *embedding, size_t point)
{
    const double u = embedding->uvw[3 * point];
    return u == u;
}

/* Returns the index of the first extended point that is not before `point`. */
size_t ffd_embedding_first_extended(const ffd_embedding *embedding, size_t point);

/* Creates an empty index. Returns NULL if memory runs out. */
struct cell_index *ffd_cell_index_create(void);
/* Destroys the index; NULL is allowed. */
void ffd_cell_index_destroy(struct cell_index *index);

/* The points of cell c are points[starts[c]] .. points[starts[c+1] - 1]: those with u,v,w and then the
   extended ones, each in ascending order. Cells are numbered by their spans that are not empty, u fastest. */
typedef struct cell_lists {
    size_t cells;
    size_t *starts; /* cells + 1 */
    uint32_t *points;
} cell_lists;

/* Returns the lists of an embedding, which has them from the first call on. NULL if memory runs out.
   Thread-safe. */
const cell_lists *ffd_cell_lists(const ffd_embedding *embedding);

/* Destroys the sorted points of an embedding (point_cells.h); NULL is allowed. */
void ffd_point_cells_destroy(struct point_cells *cells);

/* Checks that a lattice has the rest volume of the embedding. Errors: FFD_E_INVALID, FFD_E_ARGUMENT (no
   control points). */
ffd_status ffd_embedding_check_lattice(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                       ffd_error *error);

#endif
