/* jacobian.h - the state of `ffd jacobian`, and its parts. Declares jacobian_prepare.c, jacobian_rows.c,
   jacobian_output.c, jacobian_product.c and jacobian_check.c. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_H
#define FFD_JOB_JACOBIAN_JACOBIAN_H

#include "job/chain/pace.h"
#include "job/deform_job.h"
#include "lattice/tangent/tangents.h"
#include "points/basis_row.h"
#include <ffd/jacobian.h>
#include <ffd/points.h>

/* A lattice to derive by. */
typedef struct jacobian_link {
    size_t index;             /* in the chain */
    ffd_embedding *embedding; /* of the vertices as the earlier links leave them */
    row_seal seal;            /* if faces are held */
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

/* Returns the seal of a link; NULL: no face is held. */
static inline const row_seal *ffd_jacobian_seal(const jacobian_link *link)
{
    return link->seal.sealed ? &link->seal : NULL;
}

/* Prepares the rows. Errors: those of the job. */
ffd_status ffd_jacobian_prepare(jacobian *j, ffd_error *error);
/* Fills 3 coordinates a vertex with the positions after the first `links` links, in the lattice's space. */
ffd_status ffd_jacobian_positions(const jacobian *j, size_t links, double *positions, ffd_error *error);
/* Frees all but the job. */
void ffd_jacobian_free(jacobian *j);

/* A stored value of row 3i+a, or of row i. */
typedef struct jacobian_entry {
    uint64_t column;
    double value;
} jacobian_entry;

/* The rows of one vertex: three, or one. Columns ascend, and zeros are not stored. */
typedef struct jacobian_rows {
    size_t counts[3];
    jacobian_entry *entries[3]; /* capacity for any vertex */
    basis_row basis;
    double *sums; /* by parameters: 3 a column */
    size_t *next; /* of each link: the next entry of its extended points */
} jacobian_rows;

/* Allocates rows. Call ffd_jacobian_rows_free also after a failure. Errors: FFD_E_MEMORY. */
ffd_status ffd_jacobian_rows_make(const jacobian *j, jacobian_rows *rows, ffd_error *error);
/* Frees the memory of rows. */
void ffd_jacobian_rows_free(jacobian_rows *rows);
/* Must be called before filling the rows of a vertex that does not follow the last one. */
void ffd_jacobian_rows_begin(const jacobian *j, size_t vertex, jacobian_rows *rows);
/* Computes the rows of a vertex. */
void ffd_jacobian_rows_fill(const jacobian *j, size_t vertex, jacobian_rows *rows);

/* Returns the weights in the basis R: those of the deformed volume, NULL if all are 1. */
static inline const double *ffd_jacobian_weights(const jacobian *j, const jacobian_link *link)
{
    return j->job.chain.links[link->index].lattice->deformed_weights;
}

/* Returns the weight of a vertex, by which its rows are multiplied. */
static inline double ffd_jacobian_weight(const jacobian *j, size_t vertex)
{
    const vertex_weights *const weights = &j->job.weights;
    return weights->values ? ffd_vertex_weight(weights, vertex) : 1;
}

/* Counts the stored values of the matrix. starts: filled with rows + 1 offsets, where each row begins and the
   last one ends. *moving: the number of vertices whose rows are not empty. Errors: FFD_E_MEMORY. */
ffd_status ffd_jacobian_count(const jacobian *j, uint64_t *starts, uint64_t *moving, ffd_error *error);
/* Writes the matrix to the description's output, in the format of the name's ending; by parameters, also the
   names of the columns (STEM.columns.txt). */
ffd_status ffd_jacobian_write(const jacobian *j, const uint64_t *starts, ffd_error *error);

/* Reads the vector, and writes its product with the matrix (ffd/jacobian.h). */
ffd_status ffd_jacobian_multiply(const jacobian *j, ffd_error *error);

/* A larger error is a failure. */
#define JACOBIAN_TOLERANCE 1e-6

/* Finds the largest error at up to 16 moving vertices, relative to the larger of 1e-3 and the largest number
   in the rows of the vertex. Errors: FFD_E_MEMORY, and those of deforming. */
ffd_status ffd_jacobian_check(const jacobian *j, double *worst, ffd_error *error);

#endif
