/* fold.h - finds out whether the deformed volume folds: a proof for the whole volume, not for samples. */
#ifndef FFD_FOLD_H
#define FFD_FOLD_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ffd_fold_verdict {
    FFD_FOLDS_NONE = 0,   /* proven: det J_Q has the sign of the rest volume everywhere */
    FFD_FOLDS_SOME = 1,   /* det J_Q is 0 or has the other sign at a u,v,w, the witness */
    FFD_FOLDS_UNKNOWN = 2 /* not decided within the limits of depth and number of boxes */
} ffd_fold_verdict;

/* Returns "none", "some" or "unknown"; NULL for another value. The string is static. Thread-safe. */
FFD_API const char *ffd_fold_verdict_name(ffd_fold_verdict verdict);

/* What determinants are relative to. */
typedef enum ffd_fold_reference {
    FFD_FOLDS_TO_MEAN = 0,   /* the size of the mean of det J_P over the domain */
    FFD_FOLDS_TO_BOUNDS = 1, /* the volume of the bounds of the control points at rest by that of the domain:
                                the mean of det J_P is 0 to rounding, or weights differ too much to find it */
    FFD_FOLDS_TO_PLACE = 2   /* det J_P at the same u,v,w: one affine map moves the whole lattice */
} ffd_fold_reference;

/* Returns "mean", "bounds" or "place"; NULL for another value. The string is static. Thread-safe. */
FFD_API const char *ffd_fold_reference_name(ffd_fold_reference reference);

/* A place where the deformed volume folds. */
typedef struct ffd_fold_witness {
    bool is_there;    /* true if the verdict is FFD_FOLDS_SOME; else all other members are 0 */
    uint64_t lattice; /* of a job with several lattices: its index, from 0 */
    double uvw[3];    /* in the range of the knots */
    double xyz[3];    /* C_Q(uvw), world units */
    double rest[3];   /* C_P(uvw), world units */
    double det;       /* sign * det J_Q at uvw, divided as ffd_folds.min_det is; <= 0 */
} ffd_fold_witness;

/* The result of ffd_folds_find. Set struct_size to sizeof(ffd_folds) before the call. */
typedef struct ffd_folds {
    size_t struct_size;       /* sizeof(ffd_folds) in the caller's header */
    bool is_known;            /* false in the result of a job that did not look for folds */
    ffd_fold_verdict verdict; /* of all cells together */
    uint64_t cells;           /* number of span cells of the lattice */
    uint64_t folded_cells;    /* cells in which sign * det J_Q <= 0 at some u,v,w */
    uint64_t unknown_cells;   /* cells that are not decided */
    double min_det;           /* a lower bound of sign * det J_Q over the domain, divided by what relative_to
                                 says; -DBL_MAX stands for anything below it, too */
    ffd_fold_reference relative_to; /* what min_det and witness.det are relative to */
    ffd_fold_witness witness;
} ffd_folds;

/* Proves for each span cell that sign * det J_Q > 0 in all of it, or finds a witness of the contrary. J_Q =
   [C_u | C_v | C_w] is the Jacobian of the deformed volume, J_P that of the rest volume, and sign is the sign
   of the signed volume of the rest volume. src/maths.md 10 has the method:
   - A box or a cylinder at rest, with any weights, whose control points do not move, or are moved by one
     affine map of positive determinant (to rounding), has no folds, without a proof: the deformation is that
     map. min_det is its determinant, 1 if nothing moves. With weights, given control points that are those of
     a box are a box. All other given control points are proven, and may fold at rest already.
   - Otherwise J_Q is compared with its value at the centre of the cell: if Y J_Q is close enough to the
     identity, it is regular, and the determinant keeps its sign.
   - Otherwise the Bernstein coefficients of det J_Q decide (for a rational volume those of the 4 x 4
     determinant [W A; W_u A_u; W_v A_v; W_w A_w] = W^4 det J_Q). Boxes whose coefficients have both signs are
     halved. The sign of a coefficient counts only if its size exceeds the bound of its rounding error.
   - A cell whose volume is 0 to rounding everywhere counts as folded, with a witness.det of 0. With weights
     only if det J_Q is not positive at some place.
   With weights the witness' u,v,w, as they are given here, were looked at with 58 digits: det J_Q is not
   positive there, and witness.det has its digits. At most 64 witnesses are looked at.

   The time is bounded for any lattice, by the number of boxes whose coefficients are computed: 64 in each
   cell, and 2^26 in all (1 in each of more cells); then 2048 in each undecided cell, and 2^22 in all of them;
   then 4096 for min_det. If the determinant has more than 729 coefficients, (3 degree)^3 or with weights (4
   degree)^3, the last three are fewer in proportion, but at least 256. To each count come the boxes that wait
   when it ends, at most 60. A cell is halved at most 60 times (24 times if the determinant has more than 4096
   coefficients). With weights, the rest volume takes at most 2^14 parts of faces, and 256 for each of their
   cells.

   Zeros of det J_P on the border of the domain (an axis, edge or face that collapses) are not folds. If the
   same control points coincide in both volumes, these zeros are exact, and det J_Q > 0 is proven everywhere
   else. If det J_P is 0 there only to rounding (unclamped knots, weights that differ round the axis), det J_Q
   may be 0 to rounding too, and nothing more precise is proven for that border. If control points coincide at
   rest but not in the deformed volume, zeros are folds.

   After that, the cells with the least bounds are refined until min_det is within 1 % (or the rounding error)
   of the least determinant found, or until the boxes are used up.

   The proof is local: a volume without folds may still overlap itself, as a bar does that is bent by more
   than a full turn.

   threads: >= 1, or 0 for all cores; does not affect the result. Thread-safe. Errors: FFD_E_ARGUMENT (the
   lattice has no control points yet, threads is negative, struct_size), FFD_E_MEMORY. */
FFD_API ffd_status ffd_folds_find(const ffd_lattice *lattice, int threads, ffd_folds *folds,
                                  ffd_error *error);

/* The result of ffd_folds_barrier. */
typedef struct ffd_barrier {
    size_t struct_size; /* sizeof(ffd_barrier) in the caller's header, set before the call */
    double least; /* the least coefficient; above 0: det J_Q has the sign of the rest volume in these cells */
    double value; /* the sum of max(0, floor - c)^2 over all coefficients c */
} ffd_barrier;

/* A smooth measure of folding, for optimizers: from the Bernstein coefficients c of det J_Q in each span
   cell, (3 degree)^3 of them, divided by the mean of det J_P over the domain (src/maths.md 10.7). They bound
   the determinant from both sides: an edit with value 0 does not fold in these cells, if floor is well above
   rounding (1e-9 or more).
   - deformed: 3 numbers for each control point, u fastest, in place of the lattice's own; or NULL;
   - uvw: count places in the range of the knots, 3 numbers each: only the cells that hold one of them count.
     NaN: none. NULL: all cells count;
   - gradient: receives the derivatives of the value by the deformed control points, 3 for each, u fastest; or
     NULL;
   - threads: >= 1, or 0 for all cores; does not affect the result.
   Thread-safe. Errors: FFD_E_ARGUMENT (the lattice has no control points yet, floor or a control point is not
   finite, struct_size, threads), FFD_E_UNSUPPORTED (a lattice with weights), FFD_E_INVALID (the rest volume
   is 0), FFD_E_MEMORY. */
FFD_API ffd_status ffd_folds_barrier(const ffd_lattice *lattice, const double *deformed, double floor,
                                     const double *uvw, size_t count, int threads, ffd_barrier *barrier,
                                     double *gradient, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
