/* morphs.h - several morph targets in one job: one pass for each lattice over a mesh that is read once. */
#ifndef FFD_JOB_MORPHS_H
#define FFD_JOB_MORPHS_H

#include "job/measure/job_state.h"
#include "mesh/morph/morph_clip.h"

/* Refuses options that do not go with morph targets, and duplicate names (FFD_E_ARGUMENT). Parses the clips;
   ffd_morphs_end frees them. */
ffd_status ffd_morphs_begin(deform_job *job, ffd_error *error);
/* What a job does with each target: before its pass, and after it, when the results are complete (also after
   one that a gate refuses). job->desc has the target's lattice alone. Both may be NULL. */
typedef ffd_status morph_step(void *context, deform_job *job, size_t target, ffd_error *error);
typedef struct morph_steps {
    morph_step *before, *after;
    void *context;
    bool goes_on; /* to the next target after one that a gate refuses, which is then the error of all */
} morph_steps;

/* Runs ffd_deform_job_run for each morph target with its own lattice, and stores the worst figures in result.
   Errors: those of the steps too. */
ffd_status ffd_morphs_run_each(deform_job *job, const morph_steps *steps, ffd_job_result *result,
                               ffd_error *error);
/* Like ffd_deform_job_run, for each morph target with its own lattice. Afterwards the document can be saved
   or, in a conversion, job->base has the targets. */
ffd_status ffd_morphs_run(deform_job *job, ffd_job_result *result, ffd_error *error);
/* Frees the clips. */
void ffd_morphs_end(deform_job *job);

#endif
