/* trig.h - sine and cosine of degrees, arc tangent, with the same bits on every processor. */
#ifndef FFD_BASE_VECTOR_TRIG_H
#define FFD_BASE_VECTOR_TRIG_H

/* Computes sine and cosine: exact at multiples of 90 degrees (the reduction to a quadrant is exact),
   elsewhere within about 1 ulp (Taylor series with + - * / only). degrees must be finite. */
void ffd_sincos_degrees(double degrees, double *sine, double *cosine);

/* Fills the matrix, row by row, of the rotation by so many degrees about axis 0, 1 or 2 (x, y, z),
   right-handed. degrees must be finite. */
void ffd_axis_rotation(int axis, double degrees, double rotation[9]);

/* Returns the angle between the x axis and (x, y) in radians, 0 to pi, with an error of about 2^-51 (+ - * /
   only); 0 for (0, 0). x and y finite, y >= 0. */
double ffd_arc_tangent(double y, double x);

/* Returns the angle from the x axis to (x, y) in degrees, above -180 to 180, with the error of
   ffd_arc_tangent. x and y are finite. */
double ffd_angle_degrees(double y, double x);

#endif
