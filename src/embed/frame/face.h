/* face.h - a root that a rounding put outside the box: the closest point of the face, edge or corner that it
   left through. */
#ifndef FFD_EMBED_FRAME_FACE_H
#define FFD_EMBED_FRAME_FACE_H

#include "base/vector/vec.h"
#include <stdbool.h>

static inline double clip_to_unit(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* The full Newton step -J^{-1} F by Cramer's rule; false if J is singular. */
static inline bool newton_step(const double jacobian[9], const double equation[3], double step[3])
{
    double inverse[9];
    if (!mat_invert(jacobian, inverse))
        return false;
    mat_apply(inverse, equation, step);
    for (int a = 0; a < 3; a++)
        step[a] = -step[a];
    return true;
}

/* F and its jacobian in units of each row's tolerance (>= 0), times the least of these; a row without any
   counts most. Returns false if no row has one. */
bool ffd_weigh_rows(const double jacobian[9], const double equation[3], const double tolerance[3],
                    double weighed_jacobian[9], double weighed_equation[3]);

/* F and its jacobian (by t, row by row) at t; returns whether F is within the tolerance there. */
typedef bool (*face_function)(void *context, const double t[3], double jacobian[9], double equation[3]);

/* Looks for a t in [0,1]^3 with F(t) within the tolerance, from a t near it that has coordinates at or
   next to an end: some of these are held there, in every combination, the others follow by Gauss-Newton
   steps, each row of F weighed by its tolerance. closest: all steps are taken, to where F is least; else none
   once F is within the tolerance. On success t is the point that `function` accepted last; else it is
   unchanged. */
bool ffd_face_settle(const double tolerance[3], bool closest, face_function function, void *context,
                     double t[3]);

#endif
