/* jacobian_output.h - writes the matrix. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_OUTPUT_H
#define FFD_JOB_JACOBIAN_JACOBIAN_OUTPUT_H

#include "job/jacobian/jacobian_state.h"

/* Counts the stored values. starts: filled with rows + 1 offsets, where each row begins and the last one
   ends. *moving: the number of vertices whose rows are not empty. Errors: FFD_E_MEMORY. */
ffd_status ffd_jacobian_count(const jacobian *j, uint64_t *starts, uint64_t *moving, ffd_error *error);
/* Writes the matrix to the description's output, in the format of the name's ending; by parameters, also the
   names of the columns (STEM.columns.txt). */
ffd_status ffd_jacobian_write(const jacobian *j, const uint64_t *starts, ffd_error *error);

#endif
