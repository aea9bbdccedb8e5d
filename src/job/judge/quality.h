/* quality.h - how many faces of a mesh a deformation turns over. */
#ifndef FFD_JOB_JUDGE_QUALITY_H
#define FFD_JOB_JUDGE_QUALITY_H

#include "mesh/mesh.h"
#include <stdint.h>

/* Whether a face shows another side than before: n' . (F n) < 0 with n the face's normal (Newell's sum over
   the polygon) at rest, n' after, F = I + the mean of the corners' gradients. It finds faces in a folded part
   of the volume (there n' = cof(F) n, and cof(F) n . F n = det F |n|^2) and such that are too coarse for the
   deformation. One whose area, at rest or after, is within the rounding of its coordinates does not count,
   nor does one with a corner that is not finite. rest, deformed   3 doubles a vertex gradients        9
   doubles a vertex: F - I, row by row; NaN leaves the vertex' faces out All are numbered as the face's
   corners. */
bool ffd_quality_is_flipped(const uint32_t *corners, size_t count, const double *rest, const double *deformed,
                            const double *gradients);
/* Counts them. */
uint64_t ffd_quality_flipped(const mesh_faces *faces, const double *deformed, const double *gradients);

#endif
