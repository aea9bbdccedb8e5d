/* oracle.h - a slow B-spline volume in long double, to check the library against. It shares no code and,
   where there is a choice, no method with the library: basis functions by the plain recursion of Cox and de
   Boor, closed directions by periodic indices, sums over all control points, inversion by exclusion and
   projected Gauss-Newton steps. */
#ifndef FFD_TESTS_ORACLE_H
#define FFD_TESTS_ORACLE_H

#include <stdbool.h>
#include <stddef.h>

enum { ORACLE_MAX_POINTS = 40, ORACLE_MAX_KNOTS = 56, ORACLE_MAX_ROOTS = 16 };

/* One direction. Not closed: t holds the n + degree + 1 knots. Closed: the n + 1 breakpoints of one period.
 */
typedef struct oracle_axis {
    int n, degree;
    bool closed;
    long double t[ORACLE_MAX_KNOTS];
} oracle_axis;

/* Control points with u fastest; weights is NULL where all are 1. Both belong to the volume. */
typedef struct oracle_volume {
    oracle_axis axis[3];
    long double *points, *weights;
} oracle_volume;

long double oracle_first(const oracle_axis *axis);
long double oracle_last(const oracle_axis *axis);
long double oracle_greville(const oracle_axis *axis, int i);

/* Knot t_i of basis function index i; closed: any i, function i lives on t_i .. t_{i+degree+1} and span s of
   the period (breakpoints s, s+1) carries the functions s .. s+degree. */
long double oracle_knot(const oracle_axis *axis, int i);

/* N_{i,d}(u) and N'_{i,degree}(u), u in the domain: right-hand at knots, the domain's end closed. */
long double oracle_basis(const oracle_axis *axis, int i, int d, long double u);
long double oracle_basis_derivative(const oracle_axis *axis, int i, long double u);

/* The factor of every control point of one direction: the sum over its periodic images. derivative may be
 * NULL. */
void oracle_factors(const oracle_axis *axis, long double u, long double value[ORACLE_MAX_POINTS],
                    long double derivative[ORACLE_MAX_POINTS]);

size_t oracle_count(const oracle_volume *volume);
/* A volume with the axes given, zeroed points and, if rational, weights of 1. */
oracle_volume oracle_make(const oracle_axis axis[3], bool rational);
/* The same volume with these control points (3 * count doubles) and weights (or NULL). */
oracle_volume oracle_with_points(const oracle_axis axis[3], const double *points, const double *weights);
void oracle_free(oracle_volume *volume);

/* u inside the domain; closed directions modulo the period. */
long double oracle_wrap(const oracle_axis *axis, long double u);

/* C and, unless NULL, J row by row. uvw in the domain. */
void oracle_evaluate(const oracle_volume *volume, const long double uvw[3], long double point[3],
                     long double jacobian[9]);

/* What rounding errors are relative to: sum |P_a| R for C_a, sum (|P_a| + |C_a|) |dR| for the entries of J.
 */
void oracle_magnitude(const oracle_volume *volume, const long double uvw[3], long double point[3],
                      long double jacobian[9]);

long double oracle_determinant(const long double m[9]);
bool oracle_invert(const long double m[9], long double inverse[9]);

/* Bounds of the control points. */
void oracle_bounds(const oracle_volume *volume, long double lo[3], long double hi[3]);

/* Looks for C(uvw) = p from the start uvw by damped Gauss-Newton steps that stay in the domain (closed
   directions wrap), until they no longer gain. uvw is then the nearest point found; returns max_a |C_a - p_a|
   / extent_a. */
long double oracle_descend(const oracle_volume *volume, const long double p[3], long double uvw[3]);

/* All roots of C(uvw) = p, sorted, each once: boxes are excluded by a bound of the derivative of
   sum h (P - p) N N N over them, and every box left at the last level is a start of oracle_descend. A root is
   what ends with |C_a - p_a| <= accept * extent_a. Returns their number, at most ORACLE_MAX_ROOTS. */
int oracle_find_all(const oracle_volume *volume, const long double p[3], long double accept,
                    long double roots[ORACLE_MAX_ROOTS][3]);

/* |a - b| in one direction, modulo the period where it is closed. */
long double oracle_distance(const oracle_axis *axis, long double a, long double b);

#endif
