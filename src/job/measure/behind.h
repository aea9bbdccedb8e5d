/* behind.h - finds what stays behind when the mesh moves: sockets, cameras, lights, joints, animated pivots,
   physics shapes, and the rotations and scales of Gaussian splats. */
#ifndef FFD_JOB_MEASURE_BEHIND_H
#define FFD_JOB_MEASURE_BEHIND_H

#include "job/measure/job_state.h"

/* Fills result->behind after the pass. A place stays behind if a vertex there would be moved. Nothing does if
   no vertex moves, or if the deformation becomes a morph target. Errors: FFD_E_MEMORY. */
ffd_status ffd_behind_find(const deform_job *job, ffd_job_result *result, ffd_error *error);

#endif
