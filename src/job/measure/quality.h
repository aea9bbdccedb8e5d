/* quality.h - counts the faces that a deformation turns over. */
#ifndef FFD_JOB_MEASURE_QUALITY_H
#define FFD_JOB_MEASURE_QUALITY_H

#include "mesh/mesh.h"
#include <stdint.h>

/* Whether a face is flipped: n' . (F n) < 0, with n its normal at rest (Newell's sum over the polygon), n'
   the deformed one, and F = I + the mean of the corners' gradients. This finds faces in a folded part of the
   volume (there n' = cof(F) n, and cof(F) n . F n = det F |n|^2), and faces that are too coarse for the
   deformation. A face does not count if its area, at rest or deformed, is within the rounding of its
   coordinates, or if a corner is not finite. rest, deformed   3 doubles a vertex gradients        9 doubles a
   vertex: F - I, row-major; NaN excludes the faces of a vertex All are indexed by the face's corners. */
bool ffd_quality_is_flipped(const uint32_t *corners, size_t count, const double *rest, const double *deformed,
                            const double *gradients);
/* Counts the flipped faces. */
uint64_t ffd_quality_flipped(const mesh_faces *faces, const double *deformed, const double *gradients);

#endif
