/* face.h - handles a root that is outside of the box by a rounding error: finds the closest point of the
   face, edge or corner. */
#ifndef FFD_EMBED_FRAME_FACE_H
#define FFD_EMBED_FRAME_FACE_H

#include "base/vector/vec.h"
#include <stdbool.h>

static inline double clip_to_unit(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* Sets to = t + step, clamped to the box. */
static inline void step_from(const double t[3], const double step[3], double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = clip_to_unit(t[a] + step[a]);
}

/* Computes the Newton step -J^-1 F with Cramer's rule. Returns false if J is singular. */
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

/* Scales the rows of F and of its Jacobian by the reciprocals of their tolerances (>= 0), times the least
   positive tolerance; a row with tolerance 0 gets the greatest weight. Returns false if all tolerances are
   0. */
bool ffd_weigh_rows(const double jacobian[9], const double equation[3], const double tolerance[3],
                    double weighed_jacobian[9], double weighed_equation[3]);

/* Evaluates F and its Jacobian (by t, row-major) at t. Returns whether F is within the tolerance. */
typedef bool (*face_function)(void *context, const double t[3], double jacobian[9], double equation[3]);

/* Searches a t in [0,1]^3 with F(t) within the tolerance, starting from a nearby t with coordinates at or
   next to an end. It fixes these coordinates at the end, in every combination, and moves the others with
   Gauss-Newton steps, with rows of F weighted by their tolerance. closest: make all steps, to minimise F;
   otherwise stop once F is within the tolerance. Returns whether it was found; then t is the point that
   `function` accepted last, else it is unchanged. */
bool ffd_face_settle(const double tolerance[3], bool closest, face_function function, void *context,
                     double t[3]);

#endif
