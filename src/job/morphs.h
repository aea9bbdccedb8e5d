/* morphs.h - several morph targets in one job: one pass for each lattice over a mesh that is read once. */
#ifndef FFD_JOB_MORPHS_H
#define FFD_JOB_MORPHS_H

#include "job/measure/job_state.h"
#include "mesh/morph/morph_clip.h"

/* Refuses options that do not go with morph targets, and duplicate names (FFD_E_ARGUMENT). Parses the clips;
   ffd_morphs_end frees them. */
ffd_status ffd_morphs_begin(deform_job *job, ffd_error *error);
/* Like ffd_deform_job_run, for each morph target with its own lattice. Afterwards the document can be saved
   or, in a conversion, job->base has the targets. */
ffd_status ffd_morphs_run(deform_job *job, ffd_job_result *result, ffd_error *error);
/* Frees the clips. */
void ffd_morphs_end(deform_job *job);

#endif
