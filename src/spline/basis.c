#include "spline/basis.h"
#include "spline/triangle.h"

void ffd_basis_values(const knot_vector *knots, int span, double u, double value[MAX_ORDER])
{
    value[0] = 1;
    for (int degree = 1; degree <= knots->degree; degree++)
        triangle_raise(knots->t, span, degree, u, value);
}

/* t points to the knots from which span counts. */
static void derivatives(const double *t, int span, int d, double u, double value[MAX_ORDER],
                        double derivative[MAX_ORDER])
{
    value[0] = 1;
    for (int degree = 1; degree < d; degree++)
        triangle_raise(t, span, degree, u, value);

    /* N'_i = d/(t_{i+d} - t_i) N_{i,d-1} - d/(t_{i+d+1} - t_{i+1}) N_{i+1,d-1}: each quotient enters twice.
     */
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

void ffd_basis_local_knots(const knot_vector *knots, int span, double local[2 * MAX_DEGREE])
{
    for (int i = 0; i < 2 * knots->degree; i++)
        local[i] = knots->t[span + 1 - knots->degree + i] - knots->t[span];
}

void ffd_basis_derivatives_in(const knot_vector *knots, int span, double offset, double value[MAX_ORDER],
                              double derivative[MAX_ORDER])
{
    const int d = knots->degree;
    double local[2 * MAX_DEGREE];
    ffd_basis_local_knots(knots, span, local);
    derivatives(local, d - 1, d, offset, value, derivative);
}
