/* covariance.c - the covariances of Gaussian splats, by which they are drawn. */
#include "base/vector/exponential.h"
#include "base/vector/vec.h"
#include "splat/splat.h"
#include <float.h>
#include <math.h>

/* Logarithms beyond this give no finite squares. */
#define MOST_LOG 300

static double deviation(const splat_form *form, double scale)
{
    if (!form->is_logarithmic)
        return fabs(scale);
    return scale > MOST_LOG ? HUGE_VAL : scale < -MOST_LOG ? 0 : ffd_exp(scale);
}

void ffd_splat_covariance(const splat_ellipsoid *splat, const splat_form *form, double covariance[6])
{
    double q[4], matrix[9], square = 0;
    for (int i = 0; i < 4; i++)
        square += splat->rotation[i] * splat->rotation[i];
    const double length = sqrt(square);
    for (int i = 0; i < 4; i++)
        q[i] = splat->rotation[i] / length;
    ffd_splat_matrix(q, matrix);
    for (int i = 0; i < 6; i++)
        covariance[i] = 0;
    for (int k = 0; k < (form->is_flat ? 2 : 3); k++) {
        const double size = deviation(form, splat->scale[k]), x = size * matrix[k], y = size * matrix[3 + k],
                     z = size * matrix[6 + k];
        const double products[6] = {x * x, x * y, x * z, y * y, y * z, z * z};
        for (int i = 0; i < 6; i++)
            covariance[i] += products[i];
    }
}

void ffd_covariance_carry(const double m[9], double c[6])
{
    const double full[9] = {c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5]};
    static const int rows[6] = {0, 0, 0, 1, 1, 2}, columns[6] = {0, 1, 2, 1, 2, 2};
    double half[9];
    mat_multiply(m, full, half);
    for (int i = 0; i < 6; i++)
        c[i] = vec_dot(half + 3 * rows[i], m + 3 * columns[i]);
}
