/* jacobian_check.h - compares rows of the derivative with central differences. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_CHECK_H
#define FFD_JOB_JACOBIAN_JACOBIAN_CHECK_H

#include "job/jacobian/jacobian_state.h"

/* A larger error is a failure. */
#define JACOBIAN_TOLERANCE 1e-6

/* Finds the largest error at up to 16 moving vertices, relative to the larger of 1e-3 and the largest number
   in the rows of the vertex. Errors: FFD_E_MEMORY, and those of deforming. */
ffd_status ffd_jacobian_check(const jacobian *j, double *worst, ffd_error *error);

#endif
