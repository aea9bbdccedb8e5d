/* move_exact.h - a bend whose arc is exact: a rational quadratic (NURBS Book 7.3). */
#ifndef FFD_LATTICE_MOVE_EXACT_H
#define FFD_LATTICE_MOVE_EXACT_H

#include "lattice/mirror.h"
#include "lattice/move_action.h"

typedef struct exact_bend {
    ffd_lattice *lattice;
    const unsigned char *selected; /* a byte a point */
    const ready_move *ready;
    const mirror_plane *plane; /* NULL: not reflected */
    const char *file;
} exact_bend;

/* The layers that an exact bend bends. */
typedef struct exact_layers {
    int direction;
    size_t step;        /* from a point to the next along the direction */
    size_t first, last; /* both joints of arcs; every second one between them too */
} exact_layers;

/* Finds the layers of a bend that is known to be possible. */
exact_layers ffd_move_exact_layers(const exact_bend *bend);

/* Moves points, differences and deformed weights; makes the weights where there are none. The direction along
   the axis must be made of quadratic Bezier arcs, and its selected points be all of some of these, in
   straight rows along the axis. Errors: FFD_E_INVALID at the move, FFD_E_MEMORY. */
ffd_status ffd_move_bend_exactly(const exact_bend *bend, ffd_error *error);

#endif
