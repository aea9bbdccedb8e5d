/* points.h - free-form deformation of arrays of points in memory: embed once, then deform with any number of
   moved lattices.

   Results are those of the program `ffd` for a file with points of that number type (float32: a PLY of float,
   or a glTF; float64: a PLY of double), bit for bit, whatever the number of threads and the instruction set.
 */
#ifndef FFD_POINTS_H
#define FFD_POINTS_H

#include <ffd/embedding.h>
#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/isa.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The type of the numbers of an array. */
typedef enum ffd_number { FFD_FLOAT64 = 0, FFD_FLOAT32 } ffd_number;

/* An array of points, or of other vectors of three numbers, of the caller. What is only read is not written.
 */
typedef struct ffd_span {
    void *data;       /* of the first point; any address. May be NULL where count is 0. */
    size_t count;     /* points */
    ffd_number type;  /* in the machine's byte order */
    ptrdiff_t stride; /* bytes from a point to the next one; 0: they are packed. May be negative. */
    ptrdiff_t step;   /* bytes from x to y, and from y to z; 0: they are packed. May be negative. */
} ffd_span;

/* How a call runs. Fill with ffd_run_init; NULL in place of it: the defaults. */
typedef struct ffd_run {
    size_t struct_size; /* sizeof(ffd_run) of the caller */
    int threads;        /* 0: all cores. Never changes a bit of the result. */
    ffd_isa isa;        /* nor does this. FFD_E_ARGUMENT for one that is not available. */
    /* Called at least once, where there are points, by the thread that made the call, with the part that is
       done, 0..1. false cancels: the call ends with FFD_E_CANCELLED, and what it writes is then not defined.
       NULL: none. */
    bool (*progress)(void *user, double done);
    void *user;
} ffd_run;

/* Fills run, of which the caller knows size bytes (sizeof(ffd_run)), with defaults: all cores, the best
   instruction set, no callback. */
FFD_API void ffd_run_init(ffd_run *run, size_t size);

/* What to embed. Fill with ffd_embedding_desc_init, then set lattice and points. */
typedef struct ffd_embedding_desc {
    size_t struct_size;         /* sizeof(ffd_embedding_desc) of the caller */
    const ffd_lattice *lattice; /* its rest volume counts; needed during the call only */
    ffd_span points;            /* at rest, world units; needed during the call only */
    ffd_outside outside;        /* of points that have no u,v,w; default FFD_OUTSIDE_KEEP */
    double falloff;             /* with FFD_OUTSIDE_EXTEND: world units, 0: the displacement does not fade */
    /* A point that misses the volume by no more than this (world units) is inside, at the nearest point of
       its border; default 0. Whatever it is, a float32 point is inside where its rounding reaches. */
    double snap;
} ffd_embedding_desc;

/* Fills desc, of which the caller knows size bytes (sizeof(ffd_embedding_desc)), with defaults. */
FFD_API void ffd_embedding_desc_init(ffd_embedding_desc *desc, size_t size);

/* u,v,w of many points in one rest lattice. Never changed after it was made: any number of threads may use
 * it. */
typedef struct ffd_embedding ffd_embedding;

/* Finds u,v,w of all points (ffd/embedding.h: certified, with a status each). *embedding is the caller's, to
   be destroyed. run: NULL, or how. Memory: 25 bytes a point, and what the search needs for the lattice; 140
   bytes more for each point outside with FFD_OUTSIDE_EXTEND. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (a lattice
   with a cell without volume), FFD_E_EMBEDDING (FFD_OUTSIDE_ERROR), FFD_E_CANCELLED, FFD_E_MEMORY,
   FFD_E_LIMIT. */
FFD_API ffd_status ffd_embedding_create(const ffd_embedding_desc *desc, const ffd_run *run,
                                        ffd_embedding **embedding, ffd_error *error);

/* Frees the embedding and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_embedding_destroy(ffd_embedding **embedding);

/* The number of points, N. */
FFD_API size_t ffd_embedding_get_count(const ffd_embedding *embedding);

/* u,v,w of the points, N x 3 doubles in the knots' range, NaN where there is none. Lent by the embedding. */
FFD_API const double *ffd_embedding_get_uvw(const ffd_embedding *embedding);

/* What is known of the points, N of ffd_vertex_status. Lent by the embedding. */
FFD_API const uint8_t *ffd_embedding_get_status(const ffd_embedding *embedding);

/* Deforms points: out = in + the displacement that the lattice `moved` gives to the embedding's points,
   computed in double and rounded once to the type of out.
   - moved has the rest volume that the embedding was made of, to the bit (else FFD_E_INVALID), and control
     points moved as wanted.
   - in: the N points that were embedded. out: N points; it may be in itself.
   - gradients: NULL, or N x 9 doubles, row by row d displacement_r / d p_c. F is I + gradient.
   A point that does not move (outside, invalid, in the support of no moved control point) keeps its bits
   where in and out have the same type, and its gradient is 0. A result is never NaN unless the point is not
   finite. Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (also for a result too large for the type of
   out: the first such point is named), FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in,
                                        ffd_span out, double *gradients, const ffd_run *run,
                                        ffd_error *error);

/* The same for some of the points: vertices are count numbers below N, each greater than the one before. in,
   out and gradients are of all N points; only those of the vertices are read and written. */
FFD_API ffd_status ffd_embedding_deform_some(const ffd_embedding *embedding, const ffd_lattice *moved,
                                             const uint32_t *vertices, size_t count, ffd_span in,
                                             ffd_span out, double *gradients, const ffd_run *run,
                                             ffd_error *error);

/* Lists the points that some control points act on: those in their supports, by whole span cells, and with
   FFD_OUTSIDE_EXTEND the points outside that follow these; in ascending order. A point that is not listed
   does not move with them. control_points: count numbers, u fastest. *vertices is the caller's, freed with
   ffd_free. Time in proportion to the span cells and to what is listed. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY.
 */
FFD_API ffd_status ffd_embedding_affected(const ffd_embedding *embedding, const size_t *control_points,
                                          size_t count, uint32_t **vertices, size_t *vertex_count,
                                          ffd_error *error);

/* A sparse matrix by rows (CSR). Freed with ffd_csr_free. */
typedef struct ffd_csr {
    size_t rows, columns;
    size_t *starts;    /* rows + 1: the entries of row i are starts[i] .. starts[i+1]-1 */
    uint32_t *indices; /* their columns, ascending in a row */
    double *values;
} ffd_csr;

/* dX/dQ: row i has, for each control point that acts on point i, R_j(u_i) (NURBS Book 4.2), the derivative of
   each coordinate of the point by the same coordinate of the control point. Rows of points that do not move
   are empty; those of points outside that are extended are the border point's, times what the falloff leaves.
   Values of 0 are left out. matrix is filled; free it with ffd_csr_free. weights: of the deformed volume, as
   many as control points; NULL: those at rest. Where a lattice has moved weights, give them:
   ffd_lattice_get_weights(moved, FFD_VOLUME_DEFORMED). Errors: FFD_E_ARGUMENT, FFD_E_INVALID (weights that
   are not positive and finite), FFD_E_CANCELLED, FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_embedding_basis(const ffd_embedding *embedding, const double *weights, ffd_csr *matrix,
                                       const ffd_run *run, ffd_error *error);

/* Frees the arrays of a matrix and clears it. */
FFD_API void ffd_csr_free(ffd_csr *matrix);

/* The product of that matrix with displacements of the control points: dx = (dX/dQ) dq. dq: 3 doubles a
   control point; dx: N x 3 doubles, 0 for points that do not move. Nothing is stored. weights and errors: as
   of ffd_embedding_basis. */
FFD_API ffd_status ffd_embedding_basis_times(const ffd_embedding *embedding, const double *weights,
                                             const double *dq, double *dx, const ffd_run *run,
                                             ffd_error *error);

/* The product with the transposed matrix, as adjoint methods need it: dfdq = (dX/dQ)^T dfdx. dfdx: N x 3
   doubles; dfdq: 3 doubles a control point. Sums are made in blocks of 4096 points, joined in their order:
   the same bits for any threads. Rows of points that do not move are not read. weights and errors: as of
   ffd_embedding_basis. */
FFD_API ffd_status ffd_embedding_basis_transposed(const ffd_embedding *embedding, const double *weights,
                                                  const double *dfdx, double *dfdq, const ffd_run *run,
                                                  ffd_error *error);

/* The embedding as bytes, for this version of the library on machines of this byte order. *bytes is the
   caller's, freed with ffd_free. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_save(const ffd_embedding *embedding, void **bytes, size_t *size,
                                      ffd_error *error);

/* Makes the embedding of bytes of ffd_embedding_save; lattice has the same rest volume, to the bit. Errors:
   FFD_E_INVALID (other bytes, a byte that was changed, another lattice), FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_load(const void *bytes, size_t size, const ffd_lattice *lattice,
                                      ffd_embedding **embedding, ffd_error *error);

/* Carries normals, or tangents, of as many points as there are gradients (9 doubles each, as
   ffd_embedding_deform fills them) to the deformed surface, as ffd_deform_normal and ffd_deform_tangent do;
   out may be in. normals: of tangents the deformed unit normals, count 0 where there are none. collapsed:
   NULL, or gets the number of results without a direction, which keep theirs. Errors: FFD_E_ARGUMENT,
   FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_normals_deform(const double *gradients, ffd_span in, ffd_span out, size_t *collapsed,
                                      const ffd_run *run, ffd_error *error);
FFD_API ffd_status ffd_tangents_deform(const double *gradients, ffd_span normals, ffd_span in, ffd_span out,
                                       size_t *collapsed, const ffd_run *run, ffd_error *error);

/* Evaluates C, and where jacobians is not NULL its Jacobian, at many u,v,w, as ffd_lattice_evaluate does: uvw
   count x 3, xyz count x 3, jacobians count x 9 doubles. Errors: FFD_E_ARGUMENT, FFD_E_CANCELLED. */
FFD_API ffd_status ffd_lattice_evaluate_many(const ffd_lattice *lattice, ffd_volume volume, const double *uvw,
                                             size_t count, double *xyz, double *jacobians, const ffd_run *run,
                                             ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
