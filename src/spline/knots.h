/* knots.h - makes and asks the knot vector of one direction: validation, domain, spans, Greville abscissae.
 */
#ifndef FFD_SPLINE_KNOTS_H
#define FFD_SPLINE_KNOTS_H

#include "base/fail.h"
#include "spline/knot_vector.h"

/* Makes the knots of a kind; list holds the knots or breakpoints of the two list kinds (list_count of them),
   else NULL. Refuses what src/maths.md 3 refuses; the message names direction ('u','v','w'), index and value.
   On failure *knots is empty. */
ffd_status ffd_knots_make(knot_kind kind, int degree, size_t points, const double *list, size_t list_count,
                          char direction, knot_vector *knots, ffd_error *error);
/* Leaves an empty one, which can be freed again. */
void ffd_knots_free(knot_vector *knots);

/* The start of the domain. */
double ffd_knots_first(const knot_vector *knots);
/* The end of the domain. */
double ffd_knots_last(const knot_vector *knots);

/* The following for what is not in the domain, or is its end. */
double ffd_knots_wrap_outside(const knot_vector *knots, double u);
/* u in the domain's nearest point; closed: modulo the period into [b_0, b_n). */
static inline double ffd_knots_wrap(const knot_vector *knots, double u)
{
    const bool inside = knots->t[knots->degree] <= u && u < knots->t[knots->functions];
    return inside ? u : ffd_knots_wrap_outside(knots, u);
}

/* The span s of the domain with t_s <= u < t_{s+1}, clipped to the first and last non-empty one (NURBS Book
 * A2.1).
 */
int ffd_knots_span(const knot_vector *knots, double u);
/* Its index among the non-empty spans. */
size_t ffd_knots_span_number(const knot_vector *knots, double u);

/* g_i = (t_{i+1} + ... + t_{i+d})/d of function i. */
double ffd_knots_greville(const knot_vector *knots, size_t function);

#endif
