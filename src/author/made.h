/* made.h - the parts of a lattice that is made from another one, and their way into a lattice: offsets, no
 * moves. */
#ifndef FFD_AUTHOR_MADE_H
#define FFD_AUTHOR_MADE_H

#include "lattice/lattice.h"
#include "lattice/spec.h"

/* A box at rest: the directions of its sides in rows, and its ends along them. */
typedef struct made_box {
    double axes[9], min[3], max[3];
} made_box;

typedef struct made_lattice {
    const ffd_lattice *from;
    size_t size[3];
    int degree[3];
    bool closed[3];
    double *knots[3]; /* size + degree + 1; closed: the size + 1 breakpoints */
    bool has_box;     /* the rest is this box, in place of that of `from` */
    made_box box;
    /* 3 numbers a control point. points: NULL while the rest is that of `from`; offsets: NULL while nothing
     * moves. */
    double *points, *offsets;
    double *weights, *moved_weights; /* NULL: all 1; those at rest */
} made_lattice;

/* Begins with the parts of `from`, without control points: their arrays are NULL. Errors: FFD_E_INVALID where
   `from` has no positions yet, but moves, weights or control points, which need them. */
ffd_status ffd_made_begin(const ffd_lattice *from, made_lattice *made, ffd_error *error);
/* Begins with all of `from` but its moves: its knots and rest, and copies of its offsets and weights, which
   may be changed: offsets has 3 numbers a control point, moved_weights one where there are weights. Errors:
   FFD_E_MEMORY, and as above. */
ffd_status ffd_made_begin_same(const ffd_lattice *from, made_lattice *made, ffd_error *error);
/* Gives it weights of 1, at rest and deformed, if it has none. Errors: FFD_E_MEMORY. */
ffd_status ffd_made_give_weights(made_lattice *made, ffd_error *error);
/* Finds the box that `from` has at rest, or as it was laid round a mesh. Errors: FFD_E_INVALID where it was
   not laid yet. */
ffd_status ffd_made_find_box(const made_lattice *made, made_box *box, ffd_error *error);
/* Replaces the rest that it keeps by copies of its control points, which may be changed. Errors:
   FFD_E_INVALID where there are none yet, FFD_E_MEMORY. */
ffd_status ffd_made_take_points(made_lattice *made, ffd_error *error);
/* Frees the arrays and empties it; it can be freed again. */
void ffd_made_free(made_lattice *made);

/* Sets the knots of a direction, which are copied. Errors: FFD_E_MEMORY. */
ffd_status ffd_made_set_knots(made_lattice *made, int a, int degree, size_t size, bool closed,
                              const double *knots, ffd_error *error);
/* Returns whether the rest can stay the box that `from` has: at the Greville abscissae, without weights. */
bool ffd_made_is_box(const made_lattice *made);
/* Allocates points, offsets, weights and, if wanted, moved weights, for the size. Errors: FFD_E_MEMORY. */
ffd_status ffd_made_allocate(made_lattice *made, bool moved_weights, ffd_error *error);
/* Makes a copy of count numbers. Errors: FFD_E_MEMORY. */
ffd_status ffd_made_copy(const double *numbers, size_t count, double **copy, ffd_error *error);

/* Makes the lattice, which takes the arrays. Knots that are a preset's to the bit become that preset. Errors:
   those of ffd_lattice_from_arrays. */
ffd_status ffd_made_finish(made_lattice *made, ffd_lattice **lattice, ffd_error *error);

#endif
