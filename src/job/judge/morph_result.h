/* morph_result.h - combines the results of several morph targets of a job. */
#ifndef FFD_JOB_JUDGE_MORPH_RESULT_H
#define FFD_JOB_JUDGE_MORPH_RESULT_H

#include <ffd/job.h>

/* Stores the worst figures of count targets in all, which already holds what is known of the file. */
void ffd_morph_results_join(const ffd_job_result *targets, size_t count, ffd_job_result *all);

#endif
