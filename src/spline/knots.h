/* knots.h - the knot vector of one direction: construction, validation, domain, spans, Greville abscissae. */
#ifndef FFD_SPLINE_KNOTS_H
#define FFD_SPLINE_KNOTS_H

#include "base/fail.h"
#include "spline/knot_vector.h"

/* Returns what a message says after a degree that is refused: what to do instead; "" if that is not known. */
const char *ffd_degree_hint(double degree);

/* Makes a knot vector. list: for the two list kinds the list_count knots or breakpoints, which are copied;
   else NULL. direction: 'u', 'v' or 'w', for messages. *knots is empty after a failure. Errors: FFD_E_INVALID
   for what src/maths.md 3 refuses, with direction, index and value; FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_knots_make(knot_kind kind, int degree, size_t points, const double *list, size_t list_count,
                          char direction, knot_vector *knots, ffd_error *error);
/* Frees the knot vector and empties it; it can be freed again. */
void ffd_knots_free(knot_vector *knots);

/* Returns the start of the domain. */
double ffd_knots_first(const knot_vector *knots);
/* Returns the end of the domain. */
double ffd_knots_last(const knot_vector *knots);

/* The part of ffd_knots_wrap for u that is not inside the domain, or at its end. */
double ffd_knots_wrap_outside(const knot_vector *knots, double u);
/* Returns u clamped to the domain; closed: modulo the period, in [b_0, b_n). */
static inline double ffd_knots_wrap(const knot_vector *knots, double u)
{
    const bool inside = knots->t[knots->degree] <= u && u < knots->t[knots->functions];
    return inside ? u : ffd_knots_wrap_outside(knots, u);
}

/* Returns the span s of the domain with t_s <= u < t_{s+1}, clamped to the first and last non-empty span
   (NURBS Book A2.1). */
int ffd_knots_span(const knot_vector *knots, double u);
/* Returns the index of that span among the non-empty ones. */
size_t ffd_knots_span_index(const knot_vector *knots, double u);

/* Returns the Greville abscissa g_i = (t_{i+1} + ... + t_{i+d})/d of function i. */
double ffd_knots_greville(const knot_vector *knots, size_t function);

#endif
