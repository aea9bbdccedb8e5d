/* knot_vector.h - the knot vector of one direction. */
#ifndef FFD_SPLINE_KNOT_VECTOR_H
#define FFD_SPLINE_KNOT_VECTOR_H

#include <stdbool.h>
#include <stddef.h>

#define MAX_DEGREE 14
#define MAX_ORDER (MAX_DEGREE + 1)

typedef enum knot_kind {
    KNOTS_CLAMPED,    /* ends repeated d+1 times, uniform inside, domain [0,1] */
    KNOTS_OPEN,       /* t_i = (i-d)/(n-d), domain [0,1] */
    KNOTS_UNIFORM,    /* t_i = i/(n+d), domain [t_d, t_n] */
    KNOTS_CLOSED,     /* periodic, uniform breakpoints, period 1 */
    KNOTS_LIST,       /* the n+d+1 knots as given */
    KNOTS_CLOSED_LIST /* the n+1 breakpoints of one period as given */
} knot_kind;

/* The knot vector of a direction with n control points and degree d. A closed direction is stored as the
   equal open one: its first d control points are repeated after the last, so there are n + d basis functions,
   and function i belongs to control point i mod n. Otherwise there are n functions. The knots are t_0 ..
   t_{functions+d}, the domain is [t_d, t_functions]. */
typedef struct knot_vector {
    knot_kind kind;
    int degree;
    size_t points;    /* n, the number of distinct control points */
    size_t functions; /* number of basis functions: n, or n + d if closed */
    double *t;        /* functions + degree + 1 knots */
    int *spans;       /* the non-empty spans of the domain in ascending order: indices s with t_s < t_{s+1} */
    size_t span_count;
    double *extractions; /* weighted extraction matrix of each non-empty span (bezier.h), (degree + 1)^2
                            numbers each */
} knot_vector;

/* Returns whether the direction is periodic. */
static inline bool ffd_knots_closed(const knot_vector *knots)
{
    return knots->kind == KNOTS_CLOSED || knots->kind == KNOTS_CLOSED_LIST;
}

/* Returns the index of the control point of a basis function. */
static inline size_t ffd_knots_point(const knot_vector *knots, size_t function)
{
    return function < knots->points ? function : function - knots->points;
}

#endif
