/* folds.h - says that the deformed volume folds, or turns faces over. */
#ifndef FFD_JOB_JUDGE_FOLDS_H
#define FFD_JOB_JUDGE_FOLDS_H

#include "job/figures/pass_totals.h"
#include "mesh/mesh_log.h"

/* Describes folds, such as "folds in 3 of 27 cells, as at u,v,w = 0.5 0.5 0.5 of b.json, x,y,z = 1 2 3", or
   that they could not be ruled out. Only for verdicts other than none. lattices: the names of the job's. */
void ffd_folds_describe(const ffd_job_result *result, const char *const *lattices, char *text,
                        size_t capacity);

/* Warns of folds and of faces that are turned over. */
void ffd_folds_warn(const ffd_job_result *result, const pass_totals *totals, const char *const *lattices,
                    const mesh_log *log);

#endif
