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

/* Takes a point to where the whole action has it (a pull: as at its middle). */
void ffd_move_act(ready_move *ready, double p[3]);

/* The point of a bend at this angle, its distance from the arc's middle grown by the fraction `more`. */
void ffd_move_bend(const ready_move *ready, double degrees, double more, double p[3]);

/* Puts one coordinate of a point where an action has it. The difference gains what the point gains; where it
   is back at its place at rest nothing is left. */
static inline void ffd_move_put(double to, double rest, double *p, double *difference)
{
    const double from = *p;
    *p = to;
    if (to != from)
        *difference = to == rest ? 0 : *difference + (to - from);
}

#endif
