/* polar.h - the rotation in a matrix, and what goes with it: cube roots, quaternions. Only + - * / and square
   roots, so that the bits are the same everywhere. */
#ifndef FFD_BASE_VECTOR_POLAR_H
#define FFD_BASE_VECTOR_POLAR_H

#include <stdbool.h>

/* The rotation R of the polar decomposition m = R H, which is the one nearest to m (N. J. Higham, Computing
   the polar decomposition - with applications, 1986). One that differs from the identity by rounding is the
   identity. False where m has no inverse or mirrors; rotation then is the identity. */
bool ffd_mat_rotation(const double m[9], double rotation[9]);

/* Whether the matrix differs from the identity by no more than a number in each entry. */
bool ffd_mat_is_near_identity(const double m[9], double most);

/* The real cube root. */
double ffd_cube_root(double value);

/* The unit quaternion x,y,z,w of a rotation, w >= 0. */
void ffd_mat_quaternion(const double rotation[9], double quaternion[4]);

/* product = a b: first b, then a. It may be a or b. */
void ffd_quaternion_multiply(const double a[4], const double b[4], double product[4]);

#endif
