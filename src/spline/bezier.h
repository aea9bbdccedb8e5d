/* bezier.h - the Bezier form of a span. */
#ifndef FFD_SPLINE_BEZIER_H
#define FFD_SPLINE_BEZIER_H

#include "spline/knot_vector.h"

/* Computes the extraction matrix of a non-empty span: Bezier point r = sum_j matrix[r*(d+1)+j] P_{span-d+j}.
   It is the blossom at t_span (d-r times) and t_{span+1} (r times), and equals the result of knot insertion
   (NURBS Book A5.6). */
void ffd_bezier_extraction(const knot_vector *knots, int span, double matrix[MAX_ORDER * MAX_ORDER]);

/* Returns the extraction matrices of all non-empty spans, order * order numbers each; free with ffd_free.
   NULL if memory runs out. */
double *ffd_bezier_extractions(const knot_vector *knots);

/* Multiplies row r of each matrix by binomial(d, r), for evaluation with t^r (1-t)^(d-r) instead of the
   Bernstein polynomials. */
void ffd_bezier_weigh(const knot_vector *knots, double *extractions);

#endif
