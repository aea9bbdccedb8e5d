/* weight_tears.h - positions that are torn apart because their vertices have different weights. */
#ifndef FFD_JOB_MEASURE_WEIGHT_TEARS_H
#define FFD_JOB_MEASURE_WEIGHT_TEARS_H

#include "job/measure/job_state.h"

/* Adds the splits of the weights that the deformation moves apart to the torn edges: each is an edge
   of length 0, whose step is the distance of its vertices. *is_largest: it has the largest step. Errors:
   FFD_E_MEMORY, those of ffd_chain_apply. */
ffd_status ffd_weight_tears_add(deform_job *job, ffd_job_result *result, bool *is_largest, ffd_error *error);

#endif
