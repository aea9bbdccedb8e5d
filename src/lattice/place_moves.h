/* place_moves.h - how far moves that name a place (a pull, a falloff with a centre) take the volume there. */
#ifndef FFD_LATTICE_PLACE_MOVES_H
#define FFD_LATTICE_PLACE_MOVES_H

#include "lattice/lattice.h"
#include <ffd/embedding.h>

typedef struct place_move {
    size_t move;         /* its index */
    double asked, moved; /* how far the place was to go, and how far the move alone takes it */
    double apart;        /* the largest distance of two layers of control points next to the place, at rest */
} place_move;

/* Applies the moves again, and fills found (one entry for each move of the spec) with those whose place is
   inside the volume at rest. *count: their number. Takes the memory of another lattice. Errors: FFD_E_MEMORY,
   and those of ffd_locator_locate. */
ffd_status ffd_lattice_place_moves(const ffd_lattice *lattice, const ffd_locator *locator, place_move *found,
                                   size_t *count, ffd_error *error);

#endif
