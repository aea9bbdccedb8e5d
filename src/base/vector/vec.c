#include "base/vector/vec.h"
#include <float.h>

/* Returns the exponent of the power of two that scales the largest of three magnitudes into [0.5, 1); 0, and
 *usable false, if all are 0 or one is not finite. */
static int exponent_of(double a, double b, double c, bool *usable)
{
    const double largest = maximum_number(fabs(a), maximum_number(fabs(b), fabs(c)));
    int exponent = 0;
    *usable = *usable && largest > 0 && isfinite(a) && isfinite(b) && isfinite(c);
    frexp(largest, &exponent);
    return exponent;
}

double ffd_vec_length_scaled(const double a[3])
{
    bool usable = true;
    const int exponent = exponent_of(a[0], a[1], a[2], &usable);
    if (!usable)
        return fabs(a[0]) + fabs(a[1]) + fabs(a[2]); /* 0, infinite or NaN */
    const double scaled[3] = {ldexp(a[0], -exponent), ldexp(a[1], -exponent), ldexp(a[2], -exponent)};
    return ldexp(sqrt(vec_dot(scaled, scaled)), exponent);
}

bool ffd_mat_invert_scaled(const double m[9], double out[9])
{
    double scaled[9], cofactor[9], result[9];
    int column[3], row[3];
    bool usable = true;
    for (int c = 0; c < 3; c++) {
        column[c] = exponent_of(m[c], m[3 + c], m[6 + c], &usable);
        for (int r = 0; r < 3; r++)
            scaled[3 * r + c] = ldexp(m[3 * r + c], -column[c]);
    }
    for (int r = 0; r < 3; r++) {
        row[r] = exponent_of(scaled[3 * r], scaled[3 * r + 1], scaled[3 * r + 2], &usable);
        for (int c = 0; c < 3; c++)
            scaled[3 * r + c] = ldexp(scaled[3 * r + c], -row[r]);
    }
    mat_cofactor(scaled, cofactor);
    const double det = vec_dot(scaled, cofactor);
    if (!usable || !(det < 0 || det > 0))
        return false;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            result[3 * r + c] = ldexp(cofactor[3 * c + r] / det, -column[r] - row[c]);
            if (!isfinite(result[3 * r + c]))
                return false;
        }
    for (int i = 0; i < 9; i++)
        out[i] = result[i];
    return true;
}

bool ffd_mat_is_singular(const double m[9], double *determinant)
{
    /* The first column times the cross product of the others. */
    const double x = m[4] * m[8] - m[7] * m[5], y = m[7] * m[2] - m[1] * m[8], z = m[1] * m[5] - m[4] * m[2];
    const double det = m[0] * x + m[3] * y + m[6] * z, size = fabs(det);
    /* Sums of magnitudes are upper bounds of lengths, and need no square roots. */
    const double sizes = 32 * DBL_EPSILON * (fabs(m[0]) + fabs(m[3]) + fabs(m[6])) *
                         (fabs(m[1]) + fabs(m[4]) + fabs(m[7])) * (fabs(m[2]) + fabs(m[5]) + fabs(m[8]));
    *determinant = det;
    if (size > sizes && sizes > DBL_MIN)
        return false;
    double lengths = 16 * DBL_EPSILON;
    for (int c = 0; c < 3; c++)
        lengths *= vec_length((const double[3]){m[c], m[3 + c], m[6 + c]});
    return !(size > lengths);
}
