/* face.h - a root that a rounding put outside the box: the closest point of the face it left through. */
#ifndef FFD_EMBED_FACE_H
#define FFD_EMBED_FACE_H

#include <stdbool.h>

/* Steps from a rounding away, with every change of the coordinates that rest. */
#define FACE_STEPS 8

static inline double clip_to_unit(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* F and its jacobian in units of each row's tolerance (>= 0), times the least of these; a row without any
   counts most. False where no row has one. */
bool ffd_weigh_rows(const double jacobian[9], const double equation[3], const double tolerance[3],
                    double weighed_jacobian[9], double weighed_equation[3]);

/* One Gauss-Newton step for F = equation with the jacobian (by t, row by row) within [0,1]^3, each row
   weighed by its tolerance: coordinates at an end rest there while the gradient leads out of the box,
   the others move and are clipped. False, and t unchanged, where there is no such step. */
bool ffd_face_step(const double jacobian[9], const double equation[3], const double tolerance[3],
                   double t[3]);

#endif
