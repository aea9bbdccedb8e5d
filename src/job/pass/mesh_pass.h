/* mesh_pass.h - the input and output arrays of a pass. */
#ifndef FFD_JOB_PASS_MESH_PASS_H
#define FFD_JOB_PASS_MESH_PASS_H

#include "job/chain/chain.h"
#include "job/input/embedding_file.h"
#include "job/input/rigid_parts.h"
#include "job/input/weights.h"
#include "mesh/mesh.h"

/* Fractions of a job that are done (ffd_deadline_done): the mesh is read, its vertices are deformed, the
   result is judged. */
#define JOB_IS_OPEN 0.1
#define JOB_HAS_PASSED 0.7
#define JOB_IS_JUDGED 0.9

/* Which selected vertices count for the bounds in the totals. */
typedef enum pass_bounds {
    PASS_BOUNDS_VISIBLE, /* those of visible nodes */
    PASS_BOUNDS_SHOWN,   /* of these, those that a face, line or point uses; requires ffd_mesh_mark_used */
    PASS_BOUNDS_ALL
} pass_bounds;

/* Where a vertex is, for a pass that only locates. */
typedef enum pass_place {
    PASS_INSIDE = 0, /* it has u,v,w */
    PASS_OUTSIDE,
    PASS_ELSEWHERE /* not selected, hidden or invalid, or its transform is singular */
} pass_place;

typedef struct mesh_pass {
    mesh_document *document;
    mesh_state state;  /* what of the document is deformed; MESH_SHOWN: no morph targets then */
    bool only_base;    /* morph targets and splats stay: the results are the offsets of a further target */
    bool is_converted; /* the results are for another format (mesh_results) */
    const lattice_chain *chain;
    size_t links; /* the number of lattices that act, from the first on */
    int threads;
    const vertex_weights *weights;   /* of the document's vertices; NULL: all are 1 */
    const rigid_parts *rigid;        /* what moves as one piece; NULL: nothing */
    const embedding_file *embedding; /* of the document in the first link; NULL: search for u,v,w */
    /* Locations in the chain's only link, one a vertex: read if is_located, else filled. Or NULL; must be
       NULL with an embedding. */
    ffd_location *locations;
    bool is_located;
    bool bounds_shapes; /* fill totals.shapes: the bounds of morph targets and of the shape with default
                           weights */
    bool counts_shapes; /* count morph targets too (a pass that writes always does) */
    bool write;         /* write positions to the document, after begin_results */
    bool discards;      /* with write: compute and count the results, but leave those of the document alone */
    bool attributes;    /* write normals and tangents too */
    bool only_offsets;  /* with attributes: write those of morph targets only, not the base's */
    /* Output arrays, in the order of `ffd embed` (ffd_mesh_vertex_count), as mesh_faces numbers vertices. */
    double *uvw;       /* 3 a vertex, or NULL: u,v,w in the last link, NaN where there is none */
    uint8_t *statuses; /* ffd_vertex_status of each vertex, or NULL */
    /* Or NULL. Else the pass only locates: it sends the vertices through the links and fills this with where
       they are in the link behind them (of blocks, with links 0: in any), a pass_place each; locations and an
       embedding must be of that link. Of the other arrays it fills deformed alone: of vertices inside or
       outside, where they reach the link. */
    uint8_t *places;
    double *deformed;  /* 3 a vertex, or NULL: deformed positions in the lattice's space, unrounded; NaN where
                          the transform is singular */
    double *gradients; /* 9 a vertex, or NULL: F - I of the whole chain, row-major, in the lattice's space;
                          NaN likewise */
    /* 2 a vertex, or NULL: the largest and the smallest singular value of F, of the vertices with a node in
       turned (mesh_find_turned_function); of others, and where F is not known, as before. */
    float *stretches;
    const uint32_t *turned;
    uint8_t *collapsed; /* whether space collapses at a vertex, or NULL */
    bool determinants;  /* find the range of det F for the totals */
    bool inversions;    /* count the vertices with det F <= 0 (with determinants always) */
    /* Marks of the vertices (job/chain/marks.h): chain->marks.planes planes of kept_stride bytes, initially
       0; or NULL. */
    uint8_t *kept;
    size_t kept_stride;
    pass_bounds bounds_of;
    struct chain_pace *pace; /* the calling thread reports to it; or NULL */
} mesh_pass;

#endif
