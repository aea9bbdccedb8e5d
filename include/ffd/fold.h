/* fold.h - does the deformed volume fold? A proof over the whole volume, not a sample. */
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
    FFD_FOLDS_NONE = 0,   /* det J_Q has the sign of the rest volume everywhere: proven */
    FFD_FOLDS_SOME = 1,   /* there is a u,v,w where it has not: the witness */
    FFD_FOLDS_UNKNOWN = 2 /* neither could be shown within the depth and the boxes allowed */
} ffd_fold_verdict;

/* What is known of a lattice's folds. Set struct_size to sizeof(ffd_folds) before the call. */
typedef struct ffd_folds {
    size_t struct_size;
    ffd_fold_verdict verdict;
    uint64_t cells;         /* span cells of the lattice */
    uint64_t folded_cells;  /* that hold a u,v,w with det J_Q <= 0 (sign of the rest volume) */
    uint64_t unknown_cells; /* that could not be decided */
    double min_det;         /* a lower bound of det J_Q over the domain, relative to the mean of det J_P */
    bool has_witness;       /* with verdict some */
    double witness_uvw[3];  /* in the knots' range */
    double witness_xyz[3];  /* C_Q there, world units */
    double witness_rest[3]; /* C_P there */
    double witness_det;     /* det J_Q there, relative as min_det: <= 0 */
} ffd_folds;

/* Proves for each span cell of lattice that sign * det J_Q > 0 on all of it, J_Q = [C_u | C_v | C_w] of the
   deformed volume and sign that of the rest volume's signed volume, or finds a witness of the contrary: first
   by comparing J_Q with that of the cell's centre (Y J_Q near the identity is regular, so its determinant
   keeps its sign), else by the Bernstein coefficients of det J_Q (rational: of the 4 x 4 determinant [W A;
   W_u A_u; W_v A_v; W_w A_w] = W^4 det J_Q), halved until they are decided, to a depth of 60 halvings a cell
   (24 where the determinant has more than 4096 coefficients) and at most 2048 boxes a cell (fewer, but 256,
   where it has many coefficients; fewer in each where very many cells are undecided). A coefficient's sign
   counts only beyond a bound of its own rounding. A whole cell that is flat to rounding counts as folded,
   with a witness of 0.

   Zeros that the rest volume itself has on the domain's border (a collapsed axis, edge or face) are no folds:
   where control points coincide along it in both volumes these zeros are exact, and det J_Q > 0 is proven
   everywhere else; where the rest volume's determinant is 0 there only to rounding (unclamped knots, weights
   that differ round the axis), so may be the deformed volume's, and nothing finer is proven of that border.
   Where points coincide at rest and no longer do, nothing is excused.

   The least cells are then looked into further until min_det is within 1 % of the least determinant seen (or
   within its rounding), or a fixed number of boxes is used up. Where the rest volume has no volume to speak
   of, min_det is relative to that of its bounds instead.

   The proof is of the volume's derivative: a volume that folds nowhere may still overlap itself (a bar bent
   past a full turn).

   lattice must not need bounds. threads: 0 for all; never changes the result. Thread-safe. Errors:
   FFD_E_ARGUMENT (the lattice still needs bounds, a size), FFD_E_MEMORY. */
FFD_API ffd_status ffd_folds_find(const ffd_lattice *lattice, int threads, ffd_folds *folds,
                                  ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
