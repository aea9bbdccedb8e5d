/* tear_figures.h - counts the torn edges of a job. */
#ifndef FFD_JOB_MEASURE_TEAR_FIGURES_H
#define FFD_JOB_MEASURE_TEAR_FIGURES_H

#include "job/measure/figures.h"

/* Lays out the marks of the pass, and allocates them, job->kept. If no figures are wanted, but the
   displacement outside may jump, also allocates arrays->deformed and arrays->gradients. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_tear_figures_prepare(deform_job *job, figure_arrays *arrays, ffd_error *error);

/* Counts the torn edges. Call it after the pass and before ffd_figures_faces. Does nothing where none can be
   torn. Without arrays->faces it reads the faces itself; if that fails it warns, unless a gate needs the
   figures. */
ffd_status ffd_tear_figures_find(deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                                 ffd_error *error);

/* Whether vertices at one position with different weights are counted as torn: where that is asked for, or
   the mesh is not too large. */
bool ffd_tear_figures_count_splits(const deform_job *job);

#endif
