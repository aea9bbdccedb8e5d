/* basis.h - the non-zero basis functions at a parameter. */
#ifndef FFD_SPLINE_BASIS_H
#define FFD_SPLINE_BASIS_H

#include "spline/knot_vector.h"

/* value[j] = N_{span-d+j}(u), j = 0..d (NURBS Book A2.2). */
void ffd_basis_values(const knot_vector *knots, int span, double u, double value[MAX_ORDER]);

/* Values and first derivatives (NURBS Book A2.3 for one derivative). */
void ffd_basis_derivatives(const knot_vector *knots, int span, double u, double value[MAX_ORDER],
                           double derivative[MAX_ORDER]);
/* The same at u = t_span + offset, where offset may be finer than a double near u can tell. */
void ffd_basis_derivatives_in(const knot_vector *knots, int span, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER]);

/* The differences that the triangular scheme of a span divides by, made once for many parameters. Its units
   are the span's length, in which no difference is below 1 and so no reciprocal above it. */
typedef struct span_scheme {
    int degree;
    double length;
    double knots[2 * MAX_DEGREE]; /* those that functions of this span depend on, from the span's start */
    double reciprocals[MAX_DEGREE * MAX_ORDER / 2]; /* degree by degree, in ascending order */
    double factors[MAX_DEGREE]; /* d / (t_{i+d} - t_i) of the derivatives, by the knots' own parameter */
} span_scheme;

/* Makes the scheme of a non-empty span. */
void ffd_basis_scheme(const knot_vector *knots, int span, span_scheme *scheme);
/* ffd_basis_derivatives_in by reciprocals, within a few roundings of it: at a knot a function may miss 0 or 1
   by one. */
void ffd_basis_derivatives_by(const span_scheme *scheme, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER]);

#endif
