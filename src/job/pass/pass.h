/* pass.h - one pass over all vertices of a document: read a tile, embed, deform, hand the results back,
   count. Only tiles are in memory as doubles. Tiles are the same for any number of threads, and their sums
   are joined in order. */
#ifndef FFD_JOB_PASS_PASS_H
#define FFD_JOB_PASS_PASS_H

#include "job/chain/chain.h"
#include "job/input/embedding_file.h"
#include "mesh/mesh.h"

typedef struct pass_totals {
    uint64_t vertices, counts[FFD_VERTEX_STATUS_COUNT], moved;
    uint64_t located; /* vertices with a u,v,w in some link: those that the residuals are of */
    double residual_square_max, residual_square_sum; /* relative to the lattice's diagonal */
    uint64_t evaluations;
    uint32_t evaluations_max;
    double displacement_square_max, displacement_square_sum;
    ffd_bounds before, after;                              /* in the lattice's space */
    uint64_t outside_any;                                  /* vertices outside of at least one lattice */
    uint64_t multiple_any;                                 /* likewise */
    uint64_t unresolved;                                   /* whose search ended at its limits */
    uint64_t first_outside, first_invalid, first_overflow; /* vertex numbers; UINT64_MAX: none */
    uint64_t shapes_outside; /* vertices that a morph target moves to a place outside of a lattice */
    uint64_t first_shape_outside, first_shape_invalid; /* of morph targets; UINT64_MAX: none */
    uint64_t extended; /* of those with status outside: displaced as the border is */
    uint64_t normals_collapsed, transforms_singular;
    uint64_t normals_carried; /* not by a pass: see ffd_job_result */
    double det_min, det_max;  /* of F, where it is asked for, a link acts and none is singular; else min > max
                               */
    double embed_seconds, deform_seconds; /* summed over threads */
} pass_totals;

typedef struct mesh_pass {
    mesh_document *document;
    const lattice_chain *chain;
    size_t links; /* how many of the chain's lattices act */
    int threads;
    const embedding_file *embedding; /* of the document in the first link, or NULL: u,v,w is searched for */
    /* One a vertex: in the chain's only link, filled by the pass or, where is_located, there already; or
       NULL. Not with an embedding. */
    ffd_location *locations;
    bool is_located;
    bool write;        /* hand positions back to the document (after begin_results) */
    bool attributes;   /* and normals and tangents */
    bool only_offsets; /* with attributes: only those of morph targets; the base's are not handed back */
    /* Arrays of vertices are in the order of `ffd embed` (ffd_mesh_vertex_count), as mesh_faces counts them.
     */
    double *uvw;       /* 3 a vertex, or NULL: u,v,w in the last link, NaN where there is none */
    uint8_t *statuses; /* one a vertex, or NULL */
    double *deformed;  /* 3 a vertex, or NULL: where the chain brings it, in the lattice's space, unrounded;
                          NaN where the transform is singular */
    double *gradients; /* 9 a vertex, or NULL: F - I of the whole chain, row by row, in the lattice's space;
                          NaN likewise */
    bool determinants; /* the totals are to have the range of det F */
} mesh_pass;

/* What a thread of a pass may take, and of what looks at edges after it (quality.h): the latter for each
   lattice too. */
#define THREAD_BYTES ((size_t)5 << 20)
#define THREAD_LINK_BYTES ((size_t)400 << 10)

/* How many of the threads there is memory for, beside what is taken of the room. edge_links: the lattices
   through which they will look at edges; 0: they will not. */
int ffd_pass_threads(const mesh_room *room, size_t edge_links, int threads);

ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error);

#endif
