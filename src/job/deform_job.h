/* deform_job.h - what `ffd deform` and `ffd check` have in common: everything but the writing. */
#ifndef FFD_JOB_DEFORM_JOB_H
#define FFD_JOB_DEFORM_JOB_H

#include "job/judge/job_state.h"

/* What a job does with a description and a result of this library's sizes. */
typedef ffd_status (*deform_job_function)(const ffd_deform_desc *desc, ffd_job_result *result,
                                          ffd_error *error);

/* Does a job for a caller whose description and result may be those of an older header. */
ffd_status ffd_job_for_caller(deform_job_function run, const ffd_deform_desc *desc, ffd_job_result *result,
                              ffd_error *error);

/* Clears result and takes desc, after checking the options that do not concern the output. Errors:
   FFD_E_ARGUMENT, FFD_E_EXISTS, in result. */
ffd_status ffd_deform_job_begin(deform_job *job, const ffd_deform_desc *desc, bool check,
                                ffd_job_result *result);

/* Whether a deformation writes a mesh: else only its positions are wanted. */
bool ffd_deform_job_writes(const ffd_deform_desc *desc);

/* Reads the job's lattices into its chain, to be placed round a mesh later. share may be NULL. Errors: those
   of ffd_chain_load. */
ffd_status ffd_deform_job_load_chain(deform_job *job, const chain_outside *outside, ffd_share *share,
                                     ffd_error *error);

/* Reads lattices and mesh. */
ffd_status ffd_deform_job_open(deform_job *job, ffd_job_result *result, ffd_error *error);

/* Deforms the document's vertices, fills result with the figures and judges them. The document is ready to be
   saved afterwards. */
ffd_status ffd_deform_job_run(deform_job *job, ffd_job_result *result, ffd_error *error);

/* Frees what the job holds, puts the outcome into result and *error (which may be NULL), and returns it. */
ffd_status ffd_deform_job_end(deform_job *job, ffd_status status, ffd_job_result *result, ffd_error *error);

#endif
