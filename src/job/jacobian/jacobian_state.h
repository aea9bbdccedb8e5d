/* jacobian_state.h - the state of `ffd jacobian`. Declares functions of jacobian_prepare.c. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_STATE_H
#define FFD_JOB_JACOBIAN_JACOBIAN_STATE_H

#include "job/chain/pace.h"
#include "job/deform_job.h"
#include "lattice/tangent/tangents.h"
#include <ffd/jacobian.h>
#include <ffd/points.h>

/* A lattice to derive by. */
typedef struct jacobian_link {
    size_t number;            /* index in the chain */
    ffd_embedding *embedding; /* of the vertices as the earlier links leave them */
    double *later;            /* 9 a vertex: gradient F of all later links; NULL: there are none */
    lattice_tangents tangents;
    size_t *columns; /* of each column of tangents: its column in the whole matrix */
} jacobian_link;

typedef struct jacobian {
    const ffd_jacobian_desc *desc;
    deform_job job;
    memory_budget budget; /* after mesh and lattices */
    size_t count;         /* of vertices */
    jacobian_link *links; /* link_count entries */
    size_t link_count;
    double *inverses; /* 9 a vertex: M^-1; NULL: all are the identity, or positions are in the scene */
    bool blocks;      /* three rows a vertex, as coordinates mix; else one */
    size_t rows, columns;
    char **names; /* of the columns, if by parameters */
    chain_pace pace;
} jacobian;

/* Prepares the rows. Errors: those of the job. */
ffd_status ffd_jacobian_prepare(jacobian *j, ffd_error *error);
/* Fills 3 coordinates a vertex with the positions after the first `links` links, in the lattice's space. */
ffd_status ffd_jacobian_positions(const jacobian *j, size_t links, double *positions, ffd_error *error);
/* Frees all but the job. */
void ffd_jacobian_free(jacobian *j);

#endif
