/* polar.h - polar decomposition, cube roots and quaternions, with + - * / and square roots only, so that
   results have the same bits everywhere. */
#ifndef FFD_BASE_VECTOR_POLAR_H
#define FFD_BASE_VECTOR_POLAR_H

#include <stdbool.h>

/* Finds the rotation R of the polar decomposition m = R H, the rotation nearest to m (N. J. Higham, Computing
   the polar decomposition - with applications, 1986). If it equals the identity to rounding, it is set to the
   identity. Returns false, with the identity, if m is not invertible or has a negative determinant. */
bool ffd_mat_rotation(const double m[9], double rotation[9]);

/* Returns whether each entry of m differs from the identity by at most `most`. */
bool ffd_mat_is_near_identity(const double m[9], double most);

/* Returns the real cube root. */
double ffd_cube_root(double value);

/* Converts a rotation matrix to the unit quaternion x,y,z,w with w >= 0. */
void ffd_mat_quaternion(const double rotation[9], double quaternion[4]);

/* product = a b: rotates by b first, then by a. product may be a or b. */
void ffd_quaternion_multiply(const double a[4], const double b[4], double product[4]);

#endif
