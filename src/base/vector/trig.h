/* trig.h - sine and cosine of degrees, arc tangent; the same bits on every processor. */
#ifndef FFD_BASE_VECTOR_TRIG_H
#define FFD_BASE_VECTOR_TRIG_H

/* Exact at multiples of 90 degrees (reduction to the quadrant is exact); elsewhere within 1 ulp or so of the
   true value (Taylor sums with + - * / only). degrees must be finite. */
void ffd_sincos_degrees(double degrees, double *sine, double *cosine);

/* The angle in radians, 0 to pi, between the x axis and (x, y) with y >= 0, within 2^-51 or so; 0 for (0, 0).
   Any finite numbers (y/x by + - * / only). */
double ffd_arc_tangent(double y, double x);

#endif
