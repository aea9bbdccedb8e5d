/* move_exact.h - a bend with exact circular arcs, as rational quadratics (NURBS Book 7.3). */
#ifndef FFD_LATTICE_MOVE_EXACT_H
#define FFD_LATTICE_MOVE_EXACT_H

#include "lattice/mirror.h"
#include "lattice/move_action.h"

typedef struct exact_bend {
    ffd_lattice *lattice;
    const unsigned char *selected; /* one byte for each point */
    const ready_move *ready;
    const mirror_plane *plane; /* NULL: no mirror image */
    const char *file;
} exact_bend;

/* The layers that an exact bend moves. */
typedef struct exact_layers {
    int direction;
    size_t step;        /* index difference of consecutive points in the direction */
    size_t first, last; /* both are joints between arcs, as is every second layer between them */
} exact_layers;

/* Finds the layers of an exact bend that was checked before. */
exact_layers ffd_move_exact_layers(const exact_bend *bend);

/* Moves points, and changes differences and deformed weights; adds weights if there are none. The direction
   along the axis must consist of quadratic Bezier arcs, and the selection of whole arcs, with straight rows
   along the axis. Errors: FFD_E_INVALID at the move, FFD_E_MEMORY. */
ffd_status ffd_move_bend_exactly(const exact_bend *bend, ffd_error *error);

#endif
