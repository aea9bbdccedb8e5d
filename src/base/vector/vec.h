/* vec.h - vectors double[3] and row-major matrices double[9]. The order of operations is fixed, so results
   are reproducible to the bit. */
#ifndef FFD_BASE_VECTOR_VEC_H
#define FFD_BASE_VECTOR_VEC_H

#include "base/arithmetic.h"
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

static inline double vec_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* As vec_length, for vectors whose squares overflow, underflow or become subnormal. */
double ffd_vec_length_scaled(const double a[3]);

static inline double vec_length(const double a[3])
{
    const double square = vec_dot(a, a);
    return square > 1e-280 && square < 1e300 ? sqrt(square) : ffd_vec_length_scaled(a);
}

/* Returns the largest of the sizes of the components. */
static inline double vec_greatest(const double v[3])
{
    const double x = fabs(v[0]), y = fabs(v[1]), z = fabs(v[2]);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

/* out = a x b; must be neither a nor b. */
static inline void vec_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline bool vec_is_finite(const double a[3])
{
    return 0 * a[0] + 0 * a[1] + 0 * a[2] == 0; /* 0 times infinity or NaN is NaN */
}

/* out = m v; may be v. */
static inline void mat_apply(const double m[9], const double v[3], double out[3])
{
    const double x = v[0], y = v[1], z = v[2];
    out[0] = m[0] * x + m[1] * y + m[2] * z;
    out[1] = m[3] * x + m[4] * y + m[5] * z;
    out[2] = m[6] * x + m[7] * y + m[8] * z;
}

/* out = a b; must be neither a nor b. */
static inline void mat_multiply(const double a[9], const double b[9], double out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
}

/* out = cof(m) = det(m) m^-T: each row is the cross product of the other two rows of m. out must not be m. */
static inline void mat_cofactor(const double m[9], double out[9])
{
    vec_cross(m + 3, m + 6, out);
    vec_cross(m + 6, m, out + 3);
    vec_cross(m, m + 3, out + 6);
}

/* Returns the largest magnitude of the entries. */
static inline double mat_largest_entry(const double m[9])
{
    double largest = 0;
    for (int i = 0; i < 9; i++)
        largest = fabs(m[i]) > largest ? fabs(m[i]) : largest;
    return largest;
}

/* Returns the sum of the squares of the entries, summed row by row. */
static inline double mat_square_sum(const double m[9])
{
    return vec_dot(m, m) + vec_dot(m + 3, m + 3) + vec_dot(m + 6, m + 6);
}

/* Computes F = I + e, of the gradient e of a displacement. */
static inline void mat_add_identity(const double e[9], double f[9])
{
    for (int i = 0; i < 9; i++)
        f[i] = e[i] + (i % 4 == 0 ? 1 : 0);
}

static inline double mat_determinant(const double m[9])
{
    double c[3];
    vec_cross(m + 3, m + 6, c);
    return vec_dot(m, c);
}

/* As mat_invert, for matrices in which products of three entries overflow or underflow: rows and columns are
   scaled to size 1 by powers of two first. */
bool ffd_mat_invert_scaled(const double m[9], double out[9]);

/* Sets out to m^-1. Returns false, and leaves out unchanged, if the determinant is 0 or the result is not
   finite. */
static inline bool mat_invert(const double m[9], double out[9])
{
    double c[9], result[9];
    mat_cofactor(m, c);
    const double det = vec_dot(m, c);
    if (!(fabs(det) > 1e-250 && fabs(det) < 1e250)) /* 0, NaN, or inaccurate */
        return ffd_mat_invert_scaled(m, out);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            result[3 * r + k] = c[3 * k + r] / det;
            if (!isfinite(result[3 * r + k]))
                return false;
        }
    for (int i = 0; i < 9; i++)
        out[i] = result[i];
    return true;
}

/* Sets *determinant, and returns whether its magnitude is at most the rounding error of its terms. */
bool ffd_mat_is_singular(const double m[9], double *determinant);

#ifdef __cplusplus
}
#endif

#endif
