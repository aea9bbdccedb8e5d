/* embedding.h - u,v,w of an array of points (public: ffd/points.h). Declares functions of affected.c too. */
#ifndef FFD_POINTS_EMBEDDING_H
#define FFD_POINTS_EMBEDDING_H

#include "base/memory/hash.h"
#include "embed/boundary/boundary.h"
#include "lattice/lattice.h"
#include <ffd/points.h>

/* A point without u,v,w that follows the border. */
typedef struct extended_point {
    size_t point;
    boundary_point nearest;
} extended_point;

struct ffd_embedding {
    ffd_lattice *rest; /* a copy */
    hash128 rest_hash;
    size_t count;
    double *uvw;     /* 3 a point */
    uint8_t *status; /* one a point */
    double falloff;
    extended_point *extended; /* extended_count, by point */
    size_t extended_count;
    struct cell_index *index; /* the points of each span cell, made when first asked for (affected.c) */
};

/* Makes an embedding that has the lattice, and arrays of count points that are not filled. */
ffd_status ffd_embedding_make(const ffd_lattice *lattice, size_t count, ffd_embedding **embedding,
                              ffd_error *error);

/* Whether a point has u,v,w. */
static inline bool ffd_embedding_has(const ffd_embedding *embedding, size_t point)
{
    const double u = embedding->uvw[3 * point];
    return u == u;
}

/* The first extended point from `point` on. */
size_t ffd_embedding_first_extended(const ffd_embedding *embedding, size_t point);

/* Makes an empty place for the index; NULL if memory runs out. */
struct cell_index *ffd_cell_index_create(void);
/* Frees the index. NULL is allowed. */
void ffd_cell_index_destroy(struct cell_index *index);

/* Fails where a lattice has another rest volume. */
ffd_status ffd_embedding_check_lattice(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                       ffd_error *error);

#endif
