/* quality.h - counts the faces that a deformation turns over. */
#ifndef FFD_JOB_MEASURE_QUALITY_H
#define FFD_JOB_MEASURE_QUALITY_H

#include "mesh/mesh.h"
#include <stdint.h>

/* How the vertices of a mesh move, indexed by the corners of its faces. */
typedef struct face_motion {
    const double *rest, *deformed; /* 3 a vertex */
    const double *gradients;       /* 9 a vertex: F - I, row-major; NaN excludes the faces of a vertex */
    const uint8_t *collapsed;      /* whether det F is 0 within rounding; or NULL: nowhere */
} face_motion;

/* Whether a face is flipped: n' . (F n) < 0, with n its normal at rest (Newell's sum over the polygon), n'
   the deformed one, and F = I + the mean of the corners' gradients. This finds faces in a folded part of the
   volume (there n' = cof(F) n, and cof(F) n . F n = det F |n|^2), and faces that are too coarse for the
   deformation. A face does not count if its area, at rest or deformed, is within the rounding of its
   coordinates, if all its corners have collapsed (the sign is that of a rounding), or if a corner is not
   finite. */
bool ffd_quality_is_flipped(const uint32_t *corners, size_t count, const face_motion *motion);
/* Counts the flipped faces. motion->rest is faces->positions. */
uint64_t ffd_quality_flipped(const mesh_faces *faces, const face_motion *motion);

#endif
