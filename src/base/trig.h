/* trig.h - sine and cosine of degrees, the same bits on every processor. */
#ifndef FFD_BASE_TRIG_H
#define FFD_BASE_TRIG_H

/* Exact at multiples of 90 degrees (reduction to the quadrant is exact); elsewhere within 1 ulp or so of the
   true value (Taylor sums with + - * / only). degrees must be finite. */
void ffd_sincos_degrees(double degrees, double *sine, double *cosine);

#endif
