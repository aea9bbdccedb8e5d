/* halving.h - the middles of the longest spans of a knot vector. */
#ifndef FFD_SPLINE_HALVING_H
#define FFD_SPLINE_HALVING_H

#include "base/fail.h"

/* Fills middles, in any order, with `count` new knots: the longest of the spans from t[first] to t[last] are
   halved, until there are as many; of equally long ones the first ones first. *found: fewer than `count`
   where no double lies inside a span. The time grows with the number of knots times its logarithm. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_halve_spans(const double *t, size_t first, size_t last, size_t count, double *middles,
                           size_t *found, ffd_error *error);

#endif
