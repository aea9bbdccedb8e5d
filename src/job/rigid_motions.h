/* rigid_motions.h - the motions of the parts of a job that move as one piece. */
#ifndef FFD_JOB_RIGID_MOTIONS_H
#define FFD_JOB_RIGID_MOTIONS_H

#include "job/measure/job_state.h"

/* Finds the pieces that the description names, if it names any. Call it before results are written. Errors:
   those of ffd_rigid_parts_load. */
ffd_status ffd_rigid_pieces_load(deform_job *job, ffd_error *error);
/* Finds their motions, with the chain fitted, and fills the figures of the parts. Errors: those of
   ffd_pass_over_mesh, FFD_E_LIMIT. */
ffd_status ffd_rigid_motions_find(deform_job *job, ffd_job_result *result, ffd_error *error);
/* Lets the places of nodes and joints that carry a piece move with it. Errors: FFD_E_MEMORY. */
ffd_status ffd_rigid_move_places(deform_job *job, ffd_error *error);
/* Warns of pieces that turn in a morph target: on the way to it they are not rigid. */
void ffd_rigid_warn(const deform_job *job, const ffd_job_result *result);

#endif
