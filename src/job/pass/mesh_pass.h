/* mesh_pass.h - what a pass is to do, and the arrays that it fills. */
#ifndef FFD_JOB_PASS_MESH_PASS_H
#define FFD_JOB_PASS_MESH_PASS_H

#include "job/chain/chain.h"
#include "job/input/embedding_file.h"
#include "mesh/mesh.h"

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

#endif
