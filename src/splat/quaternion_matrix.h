/* quaternion_matrix.h - the matrix of a unit quaternion, for scalar and SIMD code: `number` is a double or a
   register of lanes. Included by splat.c and ellipsoid_kernel.c only. */
#ifndef FFD_SPLAT_QUATERNION_MATRIX_H
#define FFD_SPLAT_QUATERNION_MATRIX_H

#include "base/inline.h"

static ALWAYS_INLINE void find_matrix(const number q[4], number m[9])
{
    const number w = q[0], x = q[1], y = q[2], z = q[3];
    m[0] = 1.0 - 2.0 * (y * y + z * z);
    m[1] = 2.0 * (x * y - w * z);
    m[2] = 2.0 * (x * z + w * y);
    m[3] = 2.0 * (x * y + w * z);
    m[4] = 1.0 - 2.0 * (x * x + z * z);
    m[5] = 2.0 * (y * z - w * x);
    m[6] = 2.0 * (x * z - w * y);
    m[7] = 2.0 * (y * z + w * x);
    m[8] = 1.0 - 2.0 * (x * x + y * y);
}

#endif
