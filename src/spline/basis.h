/* basis.h - the non-zero basis functions at a parameter. */
#ifndef FFD_SPLINE_BASIS_H
#define FFD_SPLINE_BASIS_H

#include "spline/knot_vector.h"

/* value[j] = N_{span-d+j}(u), j = 0..d (NURBS Book A2.2). */
void ffd_basis_values(const knot_vector *knots, int span, double u, double value[MAX_ORDER]);

/* Values and first derivatives (NURBS Book A2.3 for one derivative). */
void ffd_basis_derivatives(const knot_vector *knots, int span, double u, double value[MAX_ORDER],
                           double derivative[MAX_ORDER]);
/* The same at u = t_span + offset; offset can resolve more than the spacing of doubles near u. */
void ffd_basis_derivatives_in(const knot_vector *knots, int span, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER]);

/* The divisors of the triangular scheme of a span, precomputed for many parameters. Lengths are in units of
   the span, so no difference is below 1 and no reciprocal above 1. */
typedef struct span_scheme {
    int degree;
    double length;
    double knots[2 * MAX_DEGREE]; /* the knots that affect the functions of this span, relative to its
                                     start */
    double reciprocals[MAX_DEGREE * MAX_ORDER / 2]; /* by ascending degree */
    double factors[MAX_DEGREE]; /* d / (t_{i+d} - t_i), for derivatives with respect to the knots' own
                                   parameter */
} span_scheme;

/* Makes the scheme of a non-empty span. */
void ffd_basis_scheme(const knot_vector *knots, int span, span_scheme *scheme);
/* As ffd_basis_derivatives_in, with reciprocals instead of divisions. The results differ by a few roundings:
   at a knot a function may differ from 0 or 1 by one ulp. */
void ffd_basis_derivatives_by(const span_scheme *scheme, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER]);

#endif
