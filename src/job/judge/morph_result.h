/* morph_result.h - the figures of a job of several morph targets, out of those of each. */
#ifndef FFD_JOB_JUDGE_MORPH_RESULT_H
#define FFD_JOB_JUDGE_MORPH_RESULT_H

#include <ffd/job.h>

/* Puts the worst of the figures of count targets into all, which has what is known of the file. */
void ffd_morph_results_join(const ffd_job_result *targets, size_t count, ffd_job_result *all);

#endif
