/* tear_figures.h - the torn edges of a job. */
#ifndef FFD_JOB_JUDGE_TEAR_FIGURES_H
#define FFD_JOB_JUDGE_TEAR_FIGURES_H

#include "job/judge/figures.h"

/* Makes the marks for the pass, where vertices may stay: job->kept. Errors: FFD_E_MEMORY. */
ffd_status ffd_tear_figures_prepare(deform_job *job, ffd_error *error);

/* After the pass, and before ffd_figures_faces: counts the torn edges. Nothing is looked at where no vertex
   stays, or all do. Without arrays->faces, the faces are read now; a failure of that is only warned of,
   unless the gate of torn edges asks for them. */
ffd_status ffd_tear_figures_find(deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                                 ffd_error *error);

/* "36 vertices of Knight_Sword stay; the largest step to a neighbour is 0.47". Only where there are any. */
void ffd_tear_figures_describe(const ffd_job_result *result, char *text, size_t capacity);

/* Warns of torn edges, with the remedy. */
void ffd_tear_figures_warn(const deform_job *job, const ffd_job_result *result);

#endif
