/* mesh_pass.h - what a pass is to do, and the arrays that it fills. */
#ifndef FFD_JOB_PASS_MESH_PASS_H
#define FFD_JOB_PASS_MESH_PASS_H

#include "job/chain/chain.h"
#include "job/input/embedding_file.h"
#include "mesh/mesh.h"

/* Which selected vertices the totals' bounds are of. */
typedef enum pass_bounds {
    PASS_BOUNDS_VISIBLE, /* those that are not hidden */
    PASS_BOUNDS_SHOWN,   /* of these, those that are in a face, line or point: after ffd_mesh_mark_used */
    PASS_BOUNDS_ALL
} pass_bounds;

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
    bool bounds_shapes; /* find where morph targets, and what their weights show, bring vertices */
    bool bounds_shown;  /* the totals' bounds are of what the default weights show, where the pass looks at
                           shapes */
    bool counts_shapes; /* count these too; where the pass writes it does so */
    bool write;         /* hand positions back to the document (after begin_results) */
    bool attributes;    /* and normals and tangents */
    bool only_offsets;  /* with attributes: only those of morph targets; the base's are not handed back */
    /* Arrays of vertices are in the order of `ffd embed` (ffd_mesh_vertex_count), as mesh_faces counts them.
     */
    double *uvw;       /* 3 a vertex, or NULL: u,v,w in the last link, NaN where there is none */
    uint8_t *statuses; /* one a vertex, or NULL */
    double *deformed;  /* 3 a vertex, or NULL: where the chain brings it, in the lattice's space, unrounded;
                          NaN where the transform is singular */
    double *gradients; /* 9 a vertex, or NULL: F - I of the whole chain, row by row, in the lattice's space;
                          NaN likewise */
    bool determinants; /* the totals are to have the range of det F */
    /* ffd_kept_planes(ffd_chain_marked) of kept_stride marks, all 0, or NULL: vertices that stay get theirs.
     */
    uint8_t *kept;
    size_t kept_stride;
    pass_bounds bounds_of;
} mesh_pass;

#endif
