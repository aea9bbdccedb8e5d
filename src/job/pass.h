/* pass.h - one pass over all vertices of a document: read a tile, embed, deform, hand the results back,
   count. Only tiles are in memory as doubles. Tiles are the same for any number of threads, and their sums
   are joined in order. */
#ifndef FFD_JOB_PASS_H
#define FFD_JOB_PASS_H

#include "job/chain.h"
#include "mesh/mesh.h"

typedef struct pass_totals {
    uint64_t vertices, counts[FFD_VERTEX_STATUS_COUNT], moved;
    uint64_t located; /* vertices with a u,v,w: those that the residuals are of */
    double residual_square_max, residual_square_sum; /* relative to the lattice's diagonal */
    uint64_t evaluations;
    uint32_t evaluations_max;
    double displacement_square_max, displacement_square_sum;
    ffd_bounds before, after;                              /* in the lattice's space */
    uint64_t outside_any;                                  /* vertices outside of at least one lattice */
    uint64_t first_outside, first_invalid, first_overflow; /* vertex numbers; UINT64_MAX: none */
    uint64_t normals_collapsed, transforms_singular;
    double embed_seconds, deform_seconds; /* summed over threads */
} pass_totals;

typedef struct mesh_pass {
    mesh_document *document;
    const lattice_chain *chain;
    size_t links; /* how many of the chain's lattices act */
    int threads;
    bool write;        /* hand positions back to the document (after begin_results) */
    bool attributes;   /* and normals and tangents */
    double *uvw;       /* 3 a vertex, or NULL: u,v,w in the last link, NaN where there is none */
    uint8_t *statuses; /* one a vertex, or NULL */
} mesh_pass;

/* Vertices of the document in the order of `ffd embed`: parts that repeat positions do not count. */
uint64_t ffd_pass_vertex_count(const mesh_document *document);

ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error);

#endif
