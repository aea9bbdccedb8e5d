#include "spline/bezier.h"
#include "base/memory/memory.h"
#include "spline/triangle.h"
#include <string.h>

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

double *ffd_bezier_extractions(const knot_vector *knots)
{
    const size_t size = (size_t)(knots->degree + 1) * (size_t)(knots->degree + 1);
    double *matrices = ffd_alloc(knots->span_count, size * sizeof(double));
    for (size_t s = 0; matrices && s < knots->span_count; s++) {
        double matrix[MAX_ORDER * MAX_ORDER];
        ffd_bezier_extraction(knots, knots->spans[s], matrix);
        memcpy(matrices + s * size, matrix, size * sizeof(double));
    }
    return matrices;
}

void ffd_bezier_weigh(const knot_vector *knots, double *extractions)
{
    const size_t order = (size_t)knots->degree + 1;
    for (size_t s = 0; s < knots->span_count; s++) {
        double binomial = 1;
        for (size_t r = 0; r < order; r++, extractions += order) {
            for (size_t j = 0; j < order; j++)
                extractions[j] *= binomial;
            binomial = binomial * (double)(order - 1 - r) / (double)(r + 1);
        }
    }
}
