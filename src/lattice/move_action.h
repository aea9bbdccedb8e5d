/* move_action.h - what the action of a move does to one point. */
#ifndef FFD_LATTICE_MOVE_ACTION_H
#define FFD_LATTICE_MOVE_ACTION_H

#include "lattice/spec.h"

/* One move in world units, with what it takes from its points. */
typedef struct ready_move {
    lattice_move move;
    double first, length;         /* s0 and s1 - s0 along the axis through about */
    double degrees, sine, cosine; /* of the last rotation: all points of a layer often turn alike */
} ready_move;

/* Whether an action has a centre, its `about`. */
bool ffd_move_has_centre(move_action action);
/* Whether it goes by the extent of its points along its axis. */
bool ffd_move_has_extent(move_action action);

/* s, the coordinate along the axis through about. */
double ffd_move_along(const lattice_move *move, const double p[3]);

/* Takes a point to where the whole action has it. */
void ffd_move_act(ready_move *ready, double p[3]);

#endif
