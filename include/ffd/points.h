/* points.h - free-form deformation of arrays of points in memory: embed the points once, then deform them
   with any number of moved lattices.

   The results equal, bit for bit, those of the program `ffd` for a file with points of the same number type
   (float32: a PLY with float, or a glTF; float64: a PLY with double), for any number of threads and any
   instruction set. */
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

/* The number type of an array: IEEE 754 binary64 or binary32, in the byte order of the machine. */
typedef enum ffd_number { FFD_FLOAT64 = 0, FFD_FLOAT32 } ffd_number;

/* An array of the caller's with three numbers x,y,z for each point. Functions write to output arrays only. */
typedef struct ffd_span {
    void *data;       /* address of x of the first point, with any alignment; may be NULL if count is 0 */
    size_t count;     /* number of points */
    ffd_number type;  /* in the machine's byte order */
    ptrdiff_t stride; /* bytes from one point to the next, may be negative; 0: 3 numbers without gap */
    ptrdiff_t step;   /* bytes from x to y and from y to z, may be negative; 0: the size of a number */
} ffd_span;

/* How a call runs. Fill with ffd_run_options_init. NULL in place of an ffd_run_options stands for the
 * defaults. */
typedef struct ffd_run_options {
    size_t struct_size; /* sizeof(ffd_run_options) in the caller's header */
    int threads;        /* >= 1, or 0 (default) for all cores; does not affect the result */
    ffd_isa isa;        /* does not affect the result; FFD_E_ARGUMENT if not available; default
                           FFD_ISA_AUTO */
    /* Callback, or NULL (default). Called in the thread that made the call, at least once if there are
       points, with the finished fraction, 0..1. If it returns false, the call fails with FFD_E_CANCELLED, and
       its output is undefined. */
    bool (*progress)(void *user, double done);
    void *user; /* passed to progress */
} ffd_run_options;

/* Sets options to defaults. size: sizeof(ffd_run_options) in the caller's header. */
FFD_API void ffd_run_options_init(ffd_run_options *options, size_t size);

/* What to embed. Fill with ffd_embedding_desc_init, then set lattice and points. */
typedef struct ffd_embedding_desc {
    size_t struct_size;         /* sizeof(ffd_embedding_desc) in the caller's header */
    const ffd_lattice *lattice; /* only its rest volume matters; used during the call only */
    ffd_span points;            /* points at rest, world units, at most 2^32 - 1; used during the call only */
    ffd_outside outside;        /* for points without u,v,w; default FFD_OUTSIDE_KEEP */
    double falloff;             /* with FFD_OUTSIDE_EXTEND: the distance in world units over which the
                                   displacement fades to 0; 0 (default): it does not fade. With
                                   other values of outside: refused */
    /* A point that is outside of the volume by at most this distance (world units, >= 0, default 0) is
       inside, at the nearest point of the border. A float32 point is inside also if its rounding reaches the
       volume. */
    double snap;
} ffd_embedding_desc;

/* Sets desc to defaults. size: sizeof(ffd_embedding_desc) in the caller's header. */
FFD_API void ffd_embedding_desc_init(ffd_embedding_desc *desc, size_t size);

/* The u,v,w of many points in one rest lattice. It is immutable: any number of threads may use it. */
typedef struct ffd_embedding ffd_embedding;

/* Finds u,v,w of all points, with the statuses and guarantees of ffd_locator_locate (ffd/embedding.h). The
   caller destroys *embedding. options may be NULL. Memory: 25 bytes a point, plus the search structure of the
   lattice; with FFD_OUTSIDE_EXTEND 140 more bytes for each point outside. Thread-safe. Errors:
   FFD_E_ARGUMENT, FFD_E_INVALID (a lattice with a cell without volume), FFD_E_EMBEDDING (FFD_OUTSIDE_ERROR;
   the message names the point), FFD_E_CANCELLED, FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_embedding_create(const ffd_embedding_desc *desc, const ffd_run_options *options,
                                        ffd_embedding **embedding, ffd_error *error);

/* Destroys the embedding and sets *embedding to NULL. embedding and *embedding may be NULL. */
FFD_API void ffd_embedding_destroy(ffd_embedding **embedding);

/* Returns the number of points, N. Thread-safe. */
FFD_API size_t ffd_embedding_get_count(const ffd_embedding *embedding);

/* Returns the u,v,w of the points: N x 3 doubles in the range of the knots, NaN for points without u,v,w.
   They belong to the embedding. Thread-safe. */
FFD_API const double *ffd_embedding_get_uvw(const ffd_embedding *embedding);

/* Returns the statuses of the points: N values of ffd_vertex_status. They belong to the embedding.
   Thread-safe. */
FFD_API const uint8_t *ffd_embedding_get_status(const ffd_embedding *embedding);

/* Deforms the points of an embedding: out = in + displacement, computed in double and rounded once to the
   type of out (src/maths.md 7.1).
   - moved: a lattice whose rest volume equals that of the embedding, to the bit (else FFD_E_INVALID), with
     moved control points.
   - in: the N points that were embedded. out: N points; may be the same array as in.
   - gradients: NULL, or N x 9 doubles, row-major, d displacement_r / d p_c; F = I + gradient.
   - options: may be NULL.

   A point that does not move (outside, invalid, or in the support of no moved control point) keeps its bits
   if in and out have the same type, and its gradient is 0. Finite points never give NaN. Thread-safe. Errors:
   FFD_E_ARGUMENT, FFD_E_INVALID (also if a result is too large for the type of out: the message names the
   first such point), FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_deform(const ffd_embedding *embedding, const ffd_lattice *moved, ffd_span in,
                                        ffd_span out, double *gradients, const ffd_run_options *options,
                                        ffd_error *error);

/* As ffd_embedding_deform, for some of the points: vertices holds count indices below N in strictly ascending
   order. in, out and gradients have N elements all the same; only those of the given vertices are read and
   written. */
FFD_API ffd_status ffd_embedding_deform_some(const ffd_embedding *embedding, const ffd_lattice *moved,
                                             const uint32_t *vertices, size_t count, ffd_span in,
                                             ffd_span out, double *gradients, const ffd_run_options *options,
                                             ffd_error *error);

/* As ffd_embedding_deform, with a weight for each point: out = in + w d for the displacement d, and the
   gradients are w E + d g^T for its gradient E.
   - weights: N numbers w from 0 to 1.
   - slopes: N x 3 doubles g, as ffd_weight_slopes fills them; NULL: all are 0. Normals and tangents need them
     where w is not the same everywhere.

   A point with w = 0 keeps its bits as one that does not move; with w = 1 and g = 0 everywhere all bits are
   those of ffd_embedding_deform. Errors also: FFD_E_INVALID (a weight that is not in that range; the message
   has its index). */
FFD_API ffd_status ffd_embedding_deform_weighted(const ffd_embedding *embedding, const ffd_lattice *moved,
                                                 const double *weights, const double *slopes, ffd_span in,
                                                 ffd_span out, double *gradients,
                                                 const ffd_run_options *options, ffd_error *error);

/* The same for some of the points, as ffd_embedding_deform_some: weights and slopes are those of all N. */
FFD_API ffd_status ffd_embedding_deform_some_weighted(const ffd_embedding *embedding,
                                                      const ffd_lattice *moved, const uint32_t *vertices,
                                                      size_t count, const double *weights,
                                                      const double *slopes, ffd_span in, ffd_span out,
                                                      double *gradients, const ffd_run_options *options,
                                                      ffd_error *error);

/* Deforms the points of an embedding by many variants of the control points, with the bits of a call of
   ffd_embedding_deform for each.
   - rows: the number of variants, K.
   - offsets: K x n x 3 doubles, u fastest: for each variant the displacements of all n control points from
     rest, as ffd_lattice_set_offsets takes them.
   - in: the N points that were embedded.
   - out: K N points, those of variant k from k N on. It must not overlap in or offsets; with K = 1 it may be
     the same array as in.
   - options: may be NULL. Threads share the variants and the points; progress is told once in a while.

   A failure that concerns a variant names it, if there are several. Memory: 40 bytes a point, kept by the
   embedding from the first such call on, and for each thread 24 n bytes for each of up to eight variants, or
   less. Thread-safe. Errors: as of ffd_lattice_set_offsets and ffd_embedding_deform. */
FFD_API ffd_status ffd_embedding_deform_many(const ffd_embedding *embedding, size_t rows,
                                             const double *offsets, ffd_span in, ffd_span out,
                                             const ffd_run_options *options, ffd_error *error);

/* Many variants of the control points, in other forms. Fill with ffd_variants_init, then set count and
   values. All arrays are used during the call only. */
typedef struct ffd_variants {
    size_t struct_size;   /* sizeof(ffd_variants) in the caller's header */
    size_t count;         /* K */
    const double *values; /* K x n x 3: displacements from rest, or deformed control points */
    bool are_points;      /* deformed control points; default: displacements from rest */
    bool w_fastest;       /* w is the fastest index of the control points, then v; default: u, as elsewhere */
    const double *control_weights; /* n weights of the deformed volume, for all variants, in that order; NULL
                                      (default): those at rest */
    const double *weights; /* N weights of the points, for all variants, as ffd_embedding_deform_weighted
                              takes them; NULL (default): all are 1 */
} ffd_variants;

/* Sets variants to defaults. size: sizeof(ffd_variants) in the caller's header. */
FFD_API void ffd_variants_init(ffd_variants *variants, size_t size);

/* As ffd_embedding_deform_many, for variants in other forms. With weights of control points each variant
   costs what a call of its own does. Errors also: as of ffd_lattice_set_weights and
   ffd_embedding_deform_weighted. */
FFD_API ffd_status ffd_embedding_deform_variants(const ffd_embedding *embedding, const ffd_variants *variants,
                                                 ffd_span in, ffd_span out, const ffd_run_options *options,
                                                 ffd_error *error);

/* Finds the slope g of weights on a surface: on a triangle it is the vector in its plane with g . e = the
   difference of the weights along each edge e; at a point it is the mean over the triangles round its
   position, weighted by their areas (src/maths.md 9.7). Points at equal positions have one slope; 0 at points
   of no triangle with an area.
   - points: at rest, as they were embedded. weights: one for each.
   - triangles: 3 indices of points for each of count triangles.
   - slopes: filled, 3 doubles for each point.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT (also an index that is not one of a point), FFD_E_INVALID (a weight
   that is not in 0 to 1), FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_weight_slopes(ffd_span points, const double *weights, const uint32_t *triangles,
                                     size_t count, double *slopes, const ffd_run_options *options,
                                     ffd_error *error);

/* Lists the points that may move with any of the given control points (count indices, u fastest): all points
   in the span cells of their supports, and with FFD_OUTSIDE_EXTEND the points outside whose border point is
   in such a cell. Other points do not move with these control points. *vertices are *vertex_count indices in
   ascending order; the caller frees them with ffd_free. The first call takes time in proportion to N, later
   ones to the number of span cells and to the length of the list. Thread-safe. Errors: FFD_E_ARGUMENT,
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_affected(const ffd_embedding *embedding, const size_t *control_points,
                                          size_t count, uint32_t **vertices, size_t *vertex_count,
                                          ffd_error *error);

/* A sparse matrix in compressed rows (CSR). Free it with ffd_csr_free. */
typedef struct ffd_csr {
    size_t rows, columns; /* number of rows and columns */
    size_t *starts;       /* rows + 1 offsets: row i has the entries starts[i] to starts[i+1]-1 */
    uint32_t *indices;    /* the column of each entry, ascending in each row */
    double *values;       /* the value of each entry */
} ffd_csr;

/* Computes dX/dQ, an N x n matrix (n control points). Entry i,j is R_j(u_i) (The NURBS Book 4.2): the
   derivative of each coordinate of point i with respect to the same coordinate of deformed control point j.
   Rows of points that do not move are empty. A point outside that is extended has the row of its border
   point, times the factor of the falloff. Values of 0 are left out.
   - weights: those of the deformed volume, n doubles; NULL: the weights at rest. If the lattice has moved
     weights, pass ffd_lattice_get_weights(moved, FFD_VOLUME_DEFORMED).
   - matrix: filled; the caller frees it with ffd_csr_free. It is empty after a failure.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (weights that are not positive and finite),
   FFD_E_CANCELLED, FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_embedding_basis(const ffd_embedding *embedding, const double *weights, ffd_csr *matrix,
                                       const ffd_run_options *options, ffd_error *error);

/* The same with the columns in the order of Python's arrays, if w_fastest: control point i,j,k has column
   (i nv + j) nw + k. The entries of each row ascend in that order. weights are u fastest as elsewhere. */
FFD_API ffd_status ffd_embedding_basis_ordered(const ffd_embedding *embedding, const double *weights,
                                               bool w_fastest, ffd_csr *matrix,
                                               const ffd_run_options *options, ffd_error *error);

/* Frees the arrays of a matrix and sets it to zeros. */
FFD_API void ffd_csr_free(ffd_csr *matrix);

/* Multiplies that matrix with displacements of the control points, without storing it: dx = (dX/dQ) dq. dq: 3
   doubles for each control point, u fastest. dx: N x 3 doubles; 0 for points that do not move. weights,
   options, threads and errors: as for ffd_embedding_basis. */
FFD_API ffd_status ffd_embedding_basis_times(const ffd_embedding *embedding, const double *weights,
                                             const double *dq, double *dx, const ffd_run_options *options,
                                             ffd_error *error);

/* Multiplies the transposed matrix with a gradient, as adjoint methods need it, without storing the matrix:
   dfdq = (dX/dQ)^T dfdx. dfdx: N x 3 doubles; rows of points that do not move are not read. dfdq: 3 doubles
   for each control point, u fastest. Sums are formed in blocks of 4096 points, which are added in their
   order: the result does not depend on the number of threads. weights, options, threads and errors: as for
   ffd_embedding_basis. */
FFD_API ffd_status ffd_embedding_basis_transposed(const ffd_embedding *embedding, const double *weights,
                                                  const double *dfdx, double *dfdq,
                                                  const ffd_run_options *options, ffd_error *error);

/* Compute the derivative of the points by the weights of the deformed volume: by h_j it is R_j (Q_j - X) /
   h_j (the quotient rule; The NURBS Book 4.4), where X is the place of the deformed volume at the point; of a
   point outside that is extended, that of its border point, times the factor of the falloff.
   - moved: a lattice with the rest volume of the embedding, to the bit (else FFD_E_INVALID), whose deformed
     control points and weights it is taken at; weights that it does not have are 1.
   - jacobian: filled, N x 3 x n doubles: that of coordinate c of point i by weight j at (3 i + c) n + j.
     w_fastest: the weights are in the order of Python's arrays, else u fastest.
   - dw: n changes of the weights, u fastest; dx: filled, N x 3 doubles, the changes of the points.
   - dfdx: N x 3 doubles, a gradient by the points; dfdw: filled, n doubles, u fastest. Sums as in
     ffd_embedding_basis_transposed.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_INVALID, FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_weights(const ffd_embedding *embedding, const ffd_lattice *moved,
                                         bool w_fastest, double *jacobian, const ffd_run_options *options,
                                         ffd_error *error);
FFD_API ffd_status ffd_embedding_weights_times(const ffd_embedding *embedding, const ffd_lattice *moved,
                                               const double *dw, double *dx, const ffd_run_options *options,
                                               ffd_error *error);
FFD_API ffd_status ffd_embedding_weights_transposed(const ffd_embedding *embedding, const ffd_lattice *moved,
                                                    const double *dfdx, double *dfdw,
                                                    const ffd_run_options *options, ffd_error *error);

/* Compute the derivative of the points by the m numbers of the placeholders of a lattice file, with the bits
   of `ffd jacobian --wrt parameters`.
   - lattice: of ffd_lattice_parse_set, with the rest volume of the embedding, to the bit (else
     FFD_E_INVALID), at whose values it is taken; its columns are those of ffd_lattice_get_column, m in
     number. Its control points must not have been set since (FFD_E_INVALID).
   - jacobian: filled, N x 3 x m doubles: that of coordinate c of point i by number k at (3 i + c) m + k.
   - dp: m changes of the numbers; dx: filled, N x 3 doubles, the changes of the points.
   - dfdx: N x 3 doubles, a gradient by the points; dfdp: filled, m doubles. Sums as in
     ffd_embedding_basis_transposed.
   - options: may be NULL.

   Memory: 32 m bytes for each control point. Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (also a drag
   after an exact bend with a placeholder), FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_parameters(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                            double *jacobian, const ffd_run_options *options,
                                            ffd_error *error);
FFD_API ffd_status ffd_embedding_parameters_times(const ffd_embedding *embedding, const ffd_lattice *lattice,
                                                  const double *dp, double *dx,
                                                  const ffd_run_options *options, ffd_error *error);
FFD_API ffd_status ffd_embedding_parameters_transposed(const ffd_embedding *embedding,
                                                       const ffd_lattice *lattice, const double *dfdx,
                                                       double *dfdp, const ffd_run_options *options,
                                                       ffd_error *error);

/* Serialises an embedding, for the same version of the library on machines of the same byte order. *bytes are
 *size bytes; the caller frees them with ffd_free. Thread-safe. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_save(const ffd_embedding *embedding, void **bytes, size_t *size,
                                      ffd_error *error);

/* Makes an embedding from size bytes of ffd_embedding_save. lattice must have the same rest volume, to the
   bit. The caller destroys *embedding. bytes and lattice are used during the call only. Thread-safe. Errors:
   FFD_E_ARGUMENT (no lattice, or one without control points), FFD_E_INVALID (not an embedding, of another
   version, damaged, or of another lattice), FFD_E_MEMORY. */
FFD_API ffd_status ffd_embedding_load(const void *bytes, size_t size, const ffd_lattice *lattice,
                                      ffd_embedding **embedding, ffd_error *error);

/* Transform normals or tangents to the deformed surface, as ffd_deform_normal and ffd_deform_tangent do
   (ffd/deform.h).
   - gradients: 9 doubles for each element of in, as ffd_embedding_deform fills them.
   - normals: the deformed unit normals at the tangents; count 0: none.
   - out: as many elements as in; may be the same array.
   - collapsed: NULL, or receives the number of elements whose result has no direction; they are copied.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_normals_deform(const double *gradients, ffd_span in, ffd_span out, size_t *collapsed,
                                      const ffd_run_options *options, ffd_error *error);
FFD_API ffd_status ffd_tangents_deform(const double *gradients, ffd_span normals, ffd_span in, ffd_span out,
                                       size_t *collapsed, const ffd_run_options *options, ffd_error *error);

/* Evaluates C and, unless jacobians is NULL, its Jacobian at count u,v,w, as ffd_lattice_evaluate does. uvw
   and xyz: count x 3 doubles; jacobians: count x 9 doubles, row-major. options may be NULL. Thread-safe.
   Errors: FFD_E_ARGUMENT, FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_evaluate_many(const ffd_lattice *lattice, ffd_volume volume, const double *uvw,
                                             size_t count, double *xyz, double *jacobians,
                                             const ffd_run_options *options, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
