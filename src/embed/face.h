/* face.h - the closest point of a face: the coordinates on the face rest, the others are solved for by least
 * squares. */
#ifndef FFD_EMBED_FACE_H
#define FFD_EMBED_FACE_H

#include <stdbool.h>

static inline double clip_to_unit(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* Moves the coordinates of t that lie inside (0,1), one or two of them, by the Gauss-Newton step for F =
   equation with the jacobian (by t, row by row), clipped to [0,1]. False, and t unchanged, where there is no
   such step. */
bool ffd_face_step(const double jacobian[9], const double equation[3], double t[3]);

#endif
