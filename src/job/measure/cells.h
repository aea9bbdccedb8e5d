/* cells.h - the figures of the cells of a volume mesh, before and after the deformation. */
#ifndef FFD_JOB_MEASURE_CELLS_H
#define FFD_JOB_MEASURE_CELLS_H

#include "job/measure/job_state.h"

/* Fails if a gate of volume cells is set and the mesh has none. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_cell_gates_check(const deform_job *job, ffd_error *error);

/* Measures the volume cells, if there are any, with the positions of the file and the results. Call it after
   the pass. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_cell_figures_find(const deform_job *job, ffd_job_result *result, ffd_error *error);

#endif
