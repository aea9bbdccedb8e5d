/* basis.h - the non-zero basis functions at a parameter, and the Bezier form of a span. */
#ifndef FFD_SPLINE_BASIS_H
#define FFD_SPLINE_BASIS_H

#include "spline/knots.h"

/* value[j] = N_{span-d+j}(u), j = 0..d (P&T A2.2). */
void ffd_basis_values(const knot_vector *knots, int span, double u, double value[MAX_ORDER]);

/* Values and first derivatives (P&T A2.3 for one derivative). */
void ffd_basis_derivatives(const knot_vector *knots, int span, double u, double value[MAX_ORDER],
                           double derivative[MAX_ORDER]);
/* The same at u = t_span + offset, where offset may be finer than a double near u can tell. */
void ffd_basis_derivatives_in(const knot_vector *knots, int span, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER]);

/* The 2 d knots round the span that functions of this span depend on, from t_span. */
void ffd_basis_local_knots(const knot_vector *knots, int span, double local[2 * MAX_DEGREE]);

/* The Bezier form of the curve over a non-empty span: Bezier point r = sum_j matrix[r*(d+1)+j] P_{span-d+j},
   the blossom at t_span (d-r times) and t_{span+1} (r times), which is what knot insertion (P&T A5.6) arrives
   at. */
void ffd_bezier_extraction(const knot_vector *knots, int span, double matrix[MAX_ORDER * MAX_ORDER]);

/* That of each non-empty span, order * order numbers one after the other; the caller's (ffd_free). NULL when
   there is no memory. */
double *ffd_bezier_extractions(const knot_vector *knots);

#endif
