/* jacobian_product.h - products with the matrix, which need not be stored. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_PRODUCT_H
#define FFD_JOB_JACOBIAN_JACOBIAN_PRODUCT_H

#include "job/jacobian/jacobian_state.h"

/* Reads the vector, and writes its product with the matrix (ffd/jacobian.h). */
ffd_status ffd_jacobian_multiply(const jacobian *j, ffd_error *error);

#endif
