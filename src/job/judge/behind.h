/* behind.h - what stays as it is where the mesh is moved: sockets, cameras, lights, joints, animated pivots,
   physics shapes, and the rotations and scales of Gaussian splats. */
#ifndef FFD_JOB_JUDGE_BEHIND_H
#define FFD_JOB_JUDGE_BEHIND_H

#include "job/judge/job_state.h"

/* Fills result->behind after the pass. A place stays behind where a vertex in it would be moved; a job that
   moves no vertex, or that keeps the shape as the base of a morph target, leaves nothing behind. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_behind_find(const deform_job *job, ffd_job_result *result, ffd_error *error);

/* Logs one line for each kind of which something stays behind; with KEEP of joints, pivots and sockets none
   (ffd_rig_warn). */
void ffd_behind_warn(const ffd_job_result *result, ffd_rig rig, const mesh_log *log);

#endif
