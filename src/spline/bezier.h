/* bezier.h - the Bezier form of a span. */
#ifndef FFD_SPLINE_BEZIER_H
#define FFD_SPLINE_BEZIER_H

#include "spline/knot_vector.h"

/* The Bezier form of the curve over a non-empty span: Bezier point r = sum_j matrix[r*(d+1)+j] P_{span-d+j},
   the blossom at t_span (d-r times) and t_{span+1} (r times), which is what knot insertion (NURBS Book A5.6)
   arrives at. */
void ffd_bezier_extraction(const knot_vector *knots, int span, double matrix[MAX_ORDER * MAX_ORDER]);

/* Makes the extraction matrix of each non-empty span, order * order numbers one after the other; free with
   ffd_free. NULL if memory runs out. */
double *ffd_bezier_extractions(const knot_vector *knots);

/* Gives row r of each of them the factor binomial(d, r): what they then make of control points is multiplied
   by t^r (1-t)^(d-r) instead of by a Bernstein polynomial. */
void ffd_bezier_weigh(const knot_vector *knots, double *extractions);

#endif
