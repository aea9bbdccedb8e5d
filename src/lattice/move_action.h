/* move_action.h - applies the action of a move to a point. */
#ifndef FFD_LATTICE_MOVE_ACTION_H
#define FFD_LATTICE_MOVE_ACTION_H

#include "lattice/spec.h"

/* A move in world units, with the quantities that depend on its points. */
typedef struct ready_move {
    lattice_move move;
    double first, length;         /* s0 and s1 - s0 along the axis through about */
    double degrees, sine, cosine; /* cache of the last rotation, because all points of a layer often have the
                                     same angle */
} ready_move;

/* Returns whether an action has a centre (`about`). */
bool ffd_move_has_centre(move_action action);
/* Returns whether an action depends on the extent of its points along its axis. */
bool ffd_move_has_extent(move_action action);

/* Returns s, the coordinate along the axis through about. */
double ffd_move_along(const lattice_move *move, const double p[3]);

/* Applies the full action, without weights, to a point (of a pull, the displacement at its centre). */
void ffd_move_act(ready_move *ready, double p[3]);

/* Moves a point to this angle of a bend, with its distance from the centre of the arc increased by the
   fraction `more`. */
void ffd_move_bend(const ready_move *ready, double degrees, double more, double p[3]);

/* Sets a coordinate of a point to its new value. The difference changes by the same amount; if the point is
   back at its rest position, the difference is exactly 0. */
static inline void ffd_move_put(double to, double rest, double *p, double *difference)
{
    const double from = *p;
    *p = to;
    if (to != from)
        *difference = to == rest ? 0 : *difference + (to - from);
}

#endif
