#include "spline/basis.h"
#include "base/arithmetic.h"
#include "spline/triangle.h"
#include <math.h>

void ffd_basis_values(const knot_vector *knots, int span, double u, double value[MAX_ORDER])
{
    value[0] = 1;
    for (int degree = 1; degree <= knots->degree; degree++)
        triangle_raise(knots->t, span, degree, u, value);
}

/* t: the array that span is an index of. */
static void derivatives(const double *t, int span, int d, double u, double value[MAX_ORDER],
                        double derivative[MAX_ORDER])
{
    value[0] = 1;
    for (int degree = 1; degree < d; degree++)
        triangle_raise(t, span, degree, u, value);

    /* N'_i = d/(t_{i+d} - t_i) N_{i,d-1} - d/(t_{i+d+1} - t_{i+1}) N_{i+1,d-1}: each quotient is used by two
       functions. */
    const double *const left = t + span + 1 - d, *const right = t + span + 1;
    double before = 0;
    for (int r = 0; r < d; r++) {
        const double quotient = value[r] * (d / (right[r] - left[r]));
        derivative[r] = before - quotient;
        before = quotient;
    }
    derivative[d] = before;
    triangle_raise(t, span, d, u, value);
}

void ffd_basis_derivatives(const knot_vector *knots, int span, double u, double value[MAX_ORDER],
                           double derivative[MAX_ORDER])
{
    derivatives(knots->t, span, knots->degree, u, value, derivative);
}

/* Copies the 2 d knots round the span, relative to t_span. */
static void local_knots(const knot_vector *knots, int span, double local[2 * MAX_DEGREE])
{
    for (int i = 0; i < 2 * knots->degree; i++)
        local[i] = knots->t[span + 1 - knots->degree + i] - knots->t[span];
}

void ffd_basis_derivatives_in(const knot_vector *knots, int span, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER])
{
    const int d = knots->degree;
    double local[2 * MAX_DEGREE];
    local_knots(knots, span, local);
    derivatives(local, d - 1, d, offset, value, derivative);
}

/* The greatest distance of a knot, in span lengths: a knot that is farther away has no effect, and products
   with it would overflow. */
#define FARTHEST 1e300

void ffd_basis_scheme(const knot_vector *knots, int span, span_scheme *scheme)
{
    const int d = knots->degree;
    double *const t = scheme->knots, *reciprocal = scheme->reciprocals;
    scheme->degree = d;
    scheme->length = knots->t[span + 1] - knots->t[span];
    local_knots(knots, span, t);
    for (int r = 0; r < d; r++)
        scheme->factors[r] = d / (t[d + r] - t[r]);
    for (int i = 0; i < 2 * d; i++)
        t[i] = minimum_number(maximum_number(t[i] / scheme->length, -FARTHEST), FARTHEST);
    for (int degree = 1; degree <= d; degree++)
        for (int r = 0; r < degree; r++)
            *reciprocal++ = 1 / (t[d + r] - t[d - degree + r]);
}

/* As triangle_raise, with reciprocals. Returns the reciprocals of the next degree. */
static const double *raise_by(const span_scheme *scheme, int degree, const double *reciprocal, double u,
                              double *value)
{
    const double *const right = scheme->knots + scheme->degree, *const left = right - degree;
    double from_left = 0;
    for (int r = 0; r < degree; r++) {
        const double share = value[r] * reciprocal[r];
        value[r] = from_left + (right[r] - u) * share;
        from_left = (u - left[r]) * share;
    }
    value[degree] = from_left;
    return reciprocal + degree;
}

void ffd_basis_derivatives_by(const span_scheme *scheme, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER])
{
    const int d = scheme->degree;
    const double u = offset / scheme->length, *reciprocal = scheme->reciprocals;
    double before = 0;
    value[0] = 1;
    for (int degree = 1; degree < d; degree++)
        reciprocal = raise_by(scheme, degree, reciprocal, u, value);
    for (int r = 0; r < d; r++) {
        const double quotient = value[r] * scheme->factors[r];
        derivative[r] = before - quotient;
        before = quotient;
    }
    derivative[d] = before;
    raise_by(scheme, d, reciprocal, u, value);
}
