#include "spline/basis.h"
#include "spline/triangle.h"

void ffd_bezier_extraction(const knot_vector *knots, int span, double matrix[MAX_ORDER * MAX_ORDER])
{
    const int d = knots->degree;
    const double first = knots->t[span], last = knots->t[span + 1];
    for (int r = 0; r <= d; r++) {
        double *const row = matrix + r * (d + 1);
        row[0] = 1;
        for (int degree = 1; degree <= d; degree++)
            triangle_raise(knots->t, span, degree, degree <= r ? last : first, row);
    }
}
