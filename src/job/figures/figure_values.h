/* figure_values.h - clears and joins results, as the table of figures says. */
#ifndef FFD_JOB_FIGURES_FIGURE_VALUES_H
#define FFD_JOB_FIGURES_FIGURE_VALUES_H

#include "job/figures/pass_totals.h"

/* Resets all figures. */
void ffd_result_clear(ffd_job_result *result);

/* Copies the figures of a pass. seconds: wall time of the pass, which is divided in proportion to the times
   of the threads. */
void ffd_result_fill(ffd_job_result *result, const pass_totals *totals, double seconds);

/* Copies the flaws of the input: violations of its format's specification. */
void ffd_result_note_flaws(ffd_job_result *result, const mesh_flaws *flaws);

/* Stores the worst figures of count targets in all, which already holds what is known of the file. */
void ffd_results_join(const ffd_job_result *targets, size_t count, ffd_job_result *all);

/* Adds the folds of volume `number`: the worse verdict, sums of cells, the first witness. */
void ffd_folds_join(const ffd_folds *next, size_t index, ffd_folds *all);

#endif
