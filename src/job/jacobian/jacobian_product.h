/* jacobian_product.h - products with the matrix, which is not stored. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_PRODUCT_H
#define FFD_JOB_JACOBIAN_JACOBIAN_PRODUCT_H

#include "job/jacobian/jacobian_state.h"

/* Reads what is multiplied and writes the product (ffd/jacobian.h). */
ffd_status ffd_jacobian_multiply(const jacobian *j, ffd_error *error);

#endif
