/* jacobian_check.h - compares rows with central differences of what the program does. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_CHECK_H
#define FFD_JOB_JACOBIAN_JACOBIAN_CHECK_H

#include "job/jacobian/jacobian_state.h"

/* A worst difference above this is a failure. */
#define JACOBIAN_TOLERANCE 1e-6

/* Finds the largest difference at 16 vertices that move, relative to the largest number of the row or 1e-3,
   whichever is more. Errors: FFD_E_MEMORY, and those of evaluating. */
ffd_status ffd_jacobian_check(const jacobian *j, double *worst, ffd_error *error);

#endif
