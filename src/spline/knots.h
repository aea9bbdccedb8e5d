/* knots.h - the knot vector of one direction: kinds, validation, domain, spans, Greville abscissae. */
#ifndef FFD_SPLINE_KNOTS_H
#define FFD_SPLINE_KNOTS_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

#define MAX_DEGREE 9
#define MAX_ORDER (MAX_DEGREE + 1)

typedef enum knot_kind {
    KNOTS_CLAMPED,    /* ends d+1 times, inside uniform, domain [0,1] */
    KNOTS_OPEN,       /* t_i = (i-d)/(n-d), domain [0,1] */
    KNOTS_UNIFORM,    /* t_i = i/(n+d), domain [t_d, t_n] */
    KNOTS_CLOSED,     /* periodic, uniform breakpoints, period 1 */
    KNOTS_LIST,       /* the n+d+1 knots as given */
    KNOTS_CLOSED_LIST /* the n+1 breakpoints of one period as given */
} knot_kind;

/* A closed direction is held as the equal open one: its first d control points stand again behind the last,
   so there are functions = n + d basis functions and control point of function i is i mod n. Else functions =
   n. Everything below speaks of basis functions and knots t_0 .. t_{functions+d}; the domain is [t_d,
   t_functions]. */
typedef struct knot_vector {
    knot_kind kind;
    int degree;
    size_t points;    /* n, distinct control points */
    size_t functions; /* n, or n + d when closed */
    double *t;        /* functions + degree + 1 knots */
    int *spans;       /* the non-empty spans of the domain, ascending: indices s with t_s < t_{s+1} */
    size_t span_count;
    double *extractions; /* the weighted Bezier form of each non-empty span (basis.h), (degree + 1)^2 numbers
                            each */
} knot_vector;

/* Makes the knots of a kind; list holds the knots or breakpoints of the two list kinds (list_count of them),
   else NULL. Refuses what src/maths.md 3 refuses; the message names direction ('u','v','w'), index and value.
   On failure *knots is empty. */
ffd_status ffd_knots_make(knot_kind kind, int degree, size_t points, const double *list, size_t list_count,
                          char direction, knot_vector *knots, ffd_error *error);
void ffd_knots_free(knot_vector *knots);

static inline bool ffd_knots_closed(const knot_vector *knots)
{
    return knots->kind == KNOTS_CLOSED || knots->kind == KNOTS_CLOSED_LIST;
}

/* The ends of the domain. */
double ffd_knots_first(const knot_vector *knots);
double ffd_knots_last(const knot_vector *knots);

/* The following for what is not in the domain, or is its end. */
double ffd_knots_wrap_outside(const knot_vector *knots, double u);
/* u in the domain's nearest point; closed: modulo the period into [b_0, b_n). */
static inline double ffd_knots_wrap(const knot_vector *knots, double u)
{
    const bool inside = knots->t[knots->degree] <= u && u < knots->t[knots->functions];
    return inside ? u : ffd_knots_wrap_outside(knots, u);
}

/* The span s of the domain with t_s <= u < t_{s+1}, clipped to the first and last non-empty one (P&T A2.1).
 */
int ffd_knots_span(const knot_vector *knots, double u);
/* Its place among the non-empty ones. */
size_t ffd_knots_span_number(const knot_vector *knots, double u);

/* The control point of basis function i. */
static inline size_t ffd_knots_point(const knot_vector *knots, size_t function)
{
    return function < knots->points ? function : function - knots->points;
}

/* g_i = (t_{i+1} + ... + t_{i+d})/d of function i. */
double ffd_knots_greville(const knot_vector *knots, size_t function);

#endif
