/* knot_vector.h - the knot vector of one direction. */
#ifndef FFD_SPLINE_KNOT_VECTOR_H
#define FFD_SPLINE_KNOT_VECTOR_H

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

/* A closed direction is held as the equal open one: its first d control points are repeated after the
   last, so there are functions = n + d basis functions and control point of function i is i mod n. Else
   functions = n. All that takes knots speaks of basis functions and knots t_0 .. t_{functions+d}; the
   domain is [t_d, t_functions]. */
typedef struct knot_vector {
    knot_kind kind;
    int degree;
    size_t points;    /* n, distinct control points */
    size_t functions; /* n, or n + d when closed */
    double *t;        /* functions + degree + 1 knots */
    int *spans;       /* the non-empty spans of the domain, ascending: indices s with t_s < t_{s+1} */
    size_t span_count;
    double *extractions; /* the weighted Bezier form of each non-empty span (bezier.h),
                            (degree + 1)^2 numbers each */
} knot_vector;

/* Whether the direction is periodic. */
static inline bool ffd_knots_closed(const knot_vector *knots)
{
    return knots->kind == KNOTS_CLOSED || knots->kind == KNOTS_CLOSED_LIST;
}

/* The control point of basis function i. */
static inline size_t ffd_knots_point(const knot_vector *knots, size_t function)
{
    return function < knots->points ? function : function - knots->points;
}

#endif
