/* evaluate_kernel.c - compiled once for each instruction set; FFD_EVALUATE_KERNEL is the name of the
   function, FFD_LANES the number of SIMD lanes, each with one point. The operations are those of
   triangle_raise (spline/triangle.h) and of the sums in lattice/evaluate.c, in the same order. */
#include "points/evaluate_kernel.h"
#include "base/inline.h"
#include <string.h>
#if FFD_LANES == 1
typedef double lanes;
#else
#include "base/vector/lanes.h"
#endif

static ALWAYS_INLINE void find_values(const span_quotients *span, int degree, lanes u, lanes *value)
{
    lanes quotient[2 * SCHEME_STEPS];
    for (size_t i = 0; i < span->count; i++) {
        const lanes part = i < span->falling ? span->knot[i] - u : u - span->knot[i];
        quotient[i] = span->width[i] == 1 ? part : part / span->width[i];
    }
    value[0] = 1 - 0 * u;
    for (int d = 1, step = 0; d <= degree; d++) {
        lanes from_left = 0 * u;
        for (int r = 0; r < d; r++, step++) {
            const lanes lower = value[r];
            value[r] = from_left + lower * quotient[span->fall[step]];
            from_left = lower * quotient[span->rise[step]];
        }
        value[d] = from_left;
    }
}

/* sum += factor * term */
static ALWAYS_INLINE void add_term(lanes sum[3], lanes factor, const lanes term[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += factor * term[c];
}

static ALWAYS_INLINE void sum_points(const int degree[3], lanes value[3][MAX_ORDER], const double *points,
                                     lanes sum[3])
{
    for (int k = 0; k <= degree[2]; k++) {
        lanes plane[3] = {0};
        for (int j = 0; j <= degree[1]; j++) {
            lanes row[3] = {0};
#pragma GCC unroll 4
            for (int i = 0; i <= degree[0]; i++, points += 3)
                for (int c = 0; c < 3; c++)
                    row[c] += value[0][i] * points[c];
            add_term(plane, value[1][j], row);
        }
        add_term(sum, value[2][k], plane);
    }
}

/* Evaluates FFD_LANES points. */
static ALWAYS_INLINE void evaluate(const evaluate_cell *cell, const int degree[3], const double *uvw,
                                   double *xyz)
{
    lanes u[3], value[3][MAX_ORDER], sum[3] = {0};
#if FFD_LANES == 1
    memcpy(u, uvw, sizeof u);
#else
    lanes_load_triples(uvw, u);
#endif
    for (int a = 0; a < 3; a++)
        find_values(cell->span[a], degree[a], u[a], value[a]);
    sum_points(degree, value, cell->points, sum);
#if FFD_LANES == 1
    memcpy(xyz, sum, sizeof sum);
#else
    lanes_store_triples(sum, xyz);
#endif
}

/* Evaluates count <= FFD_LANES points, with lanes to spare or results in several places. */
static ALWAYS_INLINE void evaluate_some(const evaluate_cell *cell, const int degree[3], size_t first,
                                        size_t count)
{
    double uvw[3 * FFD_LANES], xyz[3 * FFD_LANES];
    for (size_t l = 0; l < FFD_LANES; l++) /* lanes to spare have the first point */
        memcpy(uvw + 3 * l, cell->uvw + 3 * (first + (l < count ? l : 0)), 3 * sizeof *uvw);
    evaluate(cell, degree, uvw, xyz);
    for (size_t l = 0; l < count; l++)
        memcpy(cell->xyz + 3 * (size_t)cell->which[first + l], xyz + 3 * l, 3 * sizeof *xyz);
}

static ALWAYS_INLINE void evaluate_all(const evaluate_cell *cell, const int degree[3])
{
    size_t first = 0;
    for (; first + FFD_LANES <= cell->count; first += FFD_LANES) {
        const uint32_t *const which = cell->which + first;
        if (which[FFD_LANES - 1] - which[0] == FFD_LANES - 1) /* they ascend */
            evaluate(cell, degree, cell->uvw + 3 * first, cell->xyz + 3 * (size_t)which[0]);
        else
            evaluate_some(cell, degree, first, FFD_LANES);
    }
    if (first < cell->count)
        evaluate_some(cell, degree, first, cell->count - first);
}

void FFD_EVALUATE_KERNEL(const evaluate_cell *cell)
{
    static const int cubic[3] = {3, 3, 3}; /* constant, so that the compiler can unroll the loops */
    if (cell->degree[0] == 3 && cell->degree[1] == 3 && cell->degree[2] == 3)
        evaluate_all(cell, cubic);
    else
        evaluate_all(cell, cell->degree);
}
