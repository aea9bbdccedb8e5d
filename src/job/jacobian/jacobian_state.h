/* jacobian_state.h - what `ffd jacobian` holds while it runs. Declares functions of jacobian_prepare.c. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_STATE_H
#define FFD_JOB_JACOBIAN_JACOBIAN_STATE_H

#include "job/deform_job.h"
#include "lattice/tangent/tangents.h"
#include <ffd/jacobian.h>
#include <ffd/points.h>

/* One lattice whose control points count. */
typedef struct jacobian_link {
    size_t number;            /* in the chain */
    ffd_embedding *embedding; /* of the vertices as they arrive there */
    double *later;            /* 9 a vertex: the gradient F of all later lattices; NULL: there are none */
    lattice_tangents tangents;
    size_t *columns; /* of the whole matrix: where each of the tangents' columns belongs */
} jacobian_link;

typedef struct jacobian {
    const ffd_jacobian_desc *desc;
    deform_job job;
    memory_budget budget; /* what mesh and lattices leave */
    size_t count;         /* vertices */
    jacobian_link *links; /* link_count */
    size_t link_count;
    double *inverses; /* 9 a vertex: M^-1; NULL: all are I, or are not asked for */
    bool blocks;      /* 3 rows a vertex */
    size_t rows, columns;
    char **names; /* of the columns, by parameters */
} jacobian;

/* Finds what the rows are made of. Errors: those of the job. */
ffd_status ffd_jacobian_prepare(jacobian *j, ffd_error *error);
/* Where the vertices are after the first links, in the lattices' space: 3 a vertex. */
ffd_status ffd_jacobian_positions(const jacobian *j, size_t links, double *positions, ffd_error *error);
/* Frees what it holds, but for the job. */
void ffd_jacobian_free(jacobian *j);

#endif
