/* morphs.h - several morph targets in one job: a pass for each lattice, over one mesh that is read once. */
#ifndef FFD_JOB_MORPHS_H
#define FFD_JOB_MORPHS_H

#include "job/judge/job_state.h"
#include "mesh/morph/morph_clip.h"

/* Refuses (FFD_E_ARGUMENT) what morph targets cannot be used with, and names that are not each another; reads
   the clips, which ffd_morphs_end frees. */
ffd_status ffd_morphs_begin(deform_job *job, ffd_error *error);
/* Does what ffd_deform_job_run does, for each morph target by its own lattice. Afterwards the document is
   ready to be saved; or, where it becomes another format, job->base has the targets. */
ffd_status ffd_morphs_run(deform_job *job, ffd_job_result *result, ffd_error *error);
/* Frees the clips. */
void ffd_morphs_end(deform_job *job);

#endif
