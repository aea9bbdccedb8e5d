/* drag.h - takes places of the volume along exactly, with the least change of control points: D = B^T (B
   B^T)^+ y, with a row of B the basis functions at a place (Hsu, Hughes & Kaufman, Direct manipulation of
   free-form deformations, SIGGRAPH 1992; src/maths.md 4.5). */
#ifndef FFD_LATTICE_DRAG_H
#define FFD_LATTICE_DRAG_H

#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <stdint.h>

/* The most places of a move, with their mirror images. */
#define FFD_MAX_DRAGGED 1000

/* The bytes that a solver of this many places takes at most; per_place: the control points that act on one.
 */
uint64_t ffd_drag_bytes(uint64_t places, uint64_t per_place);

/* The basis at some places, and its factorised Gram matrix. All zeros: empty. */
typedef struct drag_solver {
    size_t places;
    size_t *start;    /* places + 1: where the entries of each place begin */
    uint32_t *column; /* of each entry, ascending within a place */
    double *value;    /* of each entry: the basis function */
    size_t columns;
    uint32_t *point; /* the control point of each column, ascending */
    /* G = B B^T, with rows and columns in the order of pivot, is L L^T: L has `rank` columns, and its rows
       are `places` apart. Where rank < places, Q R of L stands there instead, as Householder vectors below R.
     */
    double *factor, *diagonal;
    size_t *pivot, rank;
    double *lambda, *miss, *step, *sorted; /* 3 * places each */
} drag_solver;

typedef struct drag_places {
    const double *xyz;             /* of the rest volume: 3 * count numbers */
    size_t count, own;             /* those after the first `own` are mirror images of these */
    const unsigned char *selected; /* one byte for each control point that may change */
    const char *file;              /* for messages: the lattice file, */
    const lattice_move *move;      /* and the move */
} drag_places;

/* Finds the places and factorises. The caller frees the solver, also after a failure. Errors: FFD_E_INVALID
   (a place that is not inside), FFD_E_MEMORY, and those of ffd_locator_create. */
ffd_status ffd_drag_prepare(ffd_lattice *lattice, const drag_places *places, drag_solver *solver,
                            ffd_error *error);

/* Finds the least changes of the control points of the columns (3 numbers each) that move the places by `by`
   (3 numbers each): where they cannot meet all, those of least squares. Afterwards solver->miss has what is
   missing of each. */
void ffd_drag_solve(drag_solver *solver, const double *by, double *change);

/* Frees the solver and empties it. */
void ffd_drag_free(drag_solver *solver);

#endif
