/* chain.h - free-form deformation of arrays of points by several lattices, one after the other, or side by
   side (blocks).

   The results equal, bit for bit, those of the program `ffd` with several -l, or with --blocks, for a file
   with points of the same number type, for any number of threads and any instruction set. */
#ifndef FFD_CHAIN_H
#define FFD_CHAIN_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/lattice.h>
#include <ffd/points.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Many points in several lattices. u,v,w in the first lattice, or in blocks, hold for any deformed control
   points; those in later lattices are of the control points that the lattices have themselves. It is
   immutable: any number of threads may use it. */
typedef struct ffd_chain_embedding ffd_chain_embedding;

/* What to embed in several lattices. Fill with ffd_chain_desc_init, then set lattices, count and points. */
typedef struct ffd_chain_desc {
    size_t struct_size; /* sizeof(ffd_chain_desc) in the caller's header */
    /* count lattices, 1 to 1024, in their order. All must have control points (ffd_lattice_fit). They are
       copied. */
    const ffd_lattice *const *lattices;
    size_t count;
    /* false (default): one after the other: what one has moved is embedded in the next. true: side by side:
       all act on the points at rest, each point in the first lattice that holds it. */
    bool blocks;
    /* As in ffd_embedding_desc, for each lattice. FFD_OUTSIDE_ERROR refuses a point that is outside of all
       lattices. */
    ffd_span points;
    ffd_outside outside;
    double falloff, snap;
    /* NULL (default), or an embedding of the same points, with the same settings, in lattices of the same
       rest volumes (else FFD_E_INVALID): u,v,w in the first lattice, or in blocks, are taken from it. Used
       during the call only. */
    const ffd_chain_embedding *start;
} ffd_chain_desc;

/* Sets desc to defaults. size: sizeof(ffd_chain_desc) in the caller's header. */
FFD_API void ffd_chain_desc_init(ffd_chain_desc *desc, size_t size);

/* Finds u,v,w of all points, in later lattices where the ones before take them. The caller destroys
   *embedding. options may be NULL. Memory: 26 bytes a point and 25 for each further lattice of a chain, or 30
   with blocks; the lattices and their search structures; with FFD_OUTSIDE_EXTEND 140 more bytes for each
   point outside of a lattice. Thread-safe. Errors: as of ffd_embedding_create, also FFD_E_ARGUMENT (no
   lattice), FFD_E_LIMIT (too many). */
FFD_API ffd_status ffd_chain_embedding_create(const ffd_chain_desc *desc, const ffd_run_options *options,
                                              ffd_chain_embedding **embedding, ffd_error *error);

/* Destroys the embedding and sets *embedding to NULL. embedding and *embedding may be NULL. */
FFD_API void ffd_chain_embedding_destroy(ffd_chain_embedding **embedding);

/* Returns the number of points, N. Thread-safe. */
FFD_API size_t ffd_chain_embedding_get_count(const ffd_chain_embedding *embedding);

/* Returns u,v,w of the points in the first lattice, or with blocks in the one that holds each: N x 3 doubles
   in the range of its knots, NaN for points without. They belong to the embedding. Thread-safe. */
FFD_API const double *ffd_chain_embedding_get_uvw(const ffd_chain_embedding *embedding);

/* Returns the statuses of the points: N values of ffd_vertex_status. A point is outside if it is outside of
   all lattices; else its greatest status of all lattices counts (with blocks, that in its own). They belong
   to the embedding. Thread-safe. */
FFD_API const uint8_t *ffd_chain_embedding_get_status(const ffd_chain_embedding *embedding);

/* Returns, of blocks, the index of the lattice that moves each point: that holds it, or, extended, whose
   border is nearest; UINT32_MAX: none. N numbers, which belong to the embedding. NULL where they are one
   after the other. Thread-safe. */
FFD_API const uint32_t *ffd_chain_embedding_get_blocks(const ffd_chain_embedding *embedding);

/* Returns how many pairs of blocks have volumes that overlap, where blocks may only share faces: what is in
   both goes with the first alone. pair: filled with the indices of the first pair. Boxes with the same axes
   are always found, other volumes by sample places. Thread-safe. */
FFD_API size_t ffd_chain_embedding_get_overlaps(const ffd_chain_embedding *embedding, size_t pair[2]);

/* Finds the bounds of the finite points as the lattices of the embedding move them: what the box of a further
   lattice goes round ({"box": "mesh"}).
   - points: the N points that were embedded.
   - min, max: filled; infinite, and min greater than max, if no point is finite.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_chain_embedding_bounds(const ffd_chain_embedding *embedding, ffd_span points,
                                              double min[3], double max[3], const ffd_run_options *options,
                                              ffd_error *error);

/* A deformation of the points of an embedding. Fill with ffd_chain_deform_desc_init, then set in and out. */
typedef struct ffd_chain_deform_desc {
    size_t struct_size; /* sizeof(ffd_chain_deform_desc) in the caller's header */
    /* A lattice for each of the embedding, whose rest volume is the same, to the bit, with moved control
       points; NULL, also in place of all (default): as in ffd_chain_desc. */
    const ffd_lattice *const *moved;
    ffd_span in;           /* the N points that were embedded */
    ffd_span out;          /* N points; may be the same array as in */
    double *gradients;     /* NULL (default), or N x 9 doubles as of ffd_embedding_deform: those of all
                              lattices together */
    const double *weights; /* NULL (default), or N numbers from 0 to 1 as of ffd_embedding_deform_weighted, */
    const double *slopes;  /* with their slopes, N x 3 doubles, or NULL */
    const uint32_t *vertices; /* NULL (default): all points are deformed; or only these, vertex_count indices
                                 in strictly ascending order */
    size_t vertex_count;
} ffd_chain_deform_desc;

/* Sets desc to defaults. size: sizeof(ffd_chain_deform_desc) in the caller's header. */
FFD_API void ffd_chain_deform_desc_init(ffd_chain_deform_desc *desc, size_t size);

/* Deforms the points: out = in + the sum of the displacements, computed in double and rounded once to the
   type of out (src/maths.md 7.3). Points are looked up anew in the lattices that come after the first one
   that has other control points. Points that do not move keep their bits as of ffd_embedding_deform. options
   may be NULL. Thread-safe. Errors: as of ffd_embedding_deform; FFD_E_LIMIT. */
FFD_API ffd_status ffd_chain_embedding_deform(const ffd_chain_embedding *embedding,
                                              const ffd_chain_deform_desc *desc,
                                              const ffd_run_options *options, ffd_error *error);

/* Multiply the derivative of the deformed points by the deformed control points of all lattices with changes
   of these, or its transposed with a gradient, without storing it (src/maths.md 7.6). It is taken at the
   control points and weights of the lattices in ffd_chain_desc.
   - dq: for each lattice 3 doubles for each control point, u fastest; NULL for one: they stay.
   - dx: filled, N x 3 doubles; 0 for points that do not move.
   - dfdx: N x 3 doubles, a gradient by the points.
   - dfdq: for each lattice filled, 3 doubles for each control point, u fastest; NULL for one: not wanted.
   Sums as in ffd_embedding_basis_transposed.
   - options: may be NULL.

   Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_chain_embedding_basis_times(const ffd_chain_embedding *embedding,
                                                   const double *const *dq, double *dx,
                                                   const ffd_run_options *options, ffd_error *error);
FFD_API ffd_status ffd_chain_embedding_basis_transposed(const ffd_chain_embedding *embedding,
                                                        const double *dfdx, double *const *dfdq,
                                                        const ffd_run_options *options, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
