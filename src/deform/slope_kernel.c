/* slope_kernel.c - compiled once for each instruction set; FFD_SLOPE_KERNEL is the name of the function. */
#include "deform/slope_kernel.h"
#include "base/vector/quad.h"
#include "deform/kernel.h"

typedef struct quad_range {
    quad low, high;
} quad_range;

/* Extends the ranges by the steps of a line of points, one range for each step: what the next line does need
   not wait for this one. */
static ALWAYS_INLINE void extend_ranges(size_t steps, size_t stride, const double *quads, quad_range *ranges)
{
    quad point = quad_load(quads);
#pragma GCC unroll 3
    for (size_t i = 0; i < steps; i++) {
        const quad next = quad_load(quads + (i + 1) * stride), step = quad_difference(&next, &point);
        ranges[i].low = quad_lesser(&step, &ranges[i].low);
        ranges[i].high = quad_larger(&step, &ranges[i].high);
        point = next;
    }
}

/* quads: the points, with one number more each. */
static ALWAYS_INLINE void find_range(const size_t order[3], int a, const double *quads, step_range *range)
{
    const size_t stride = a == 0 ? 4 : a == 1 ? 4 * order[0] : 4 * order[0] * order[1];
    const size_t whole = stride * order[a], count = 4 * order[0] * order[1] * order[2], steps = order[a] - 1;
    const quad first = quad_load(quads), second = quad_load(quads + stride);
    const quad begin = quad_difference(&second, &first);
    quad_range ranges[MAX_DEGREE];
    double low[4], high[4];
#pragma GCC unroll 3
    for (size_t i = 0; i < steps; i++)
        ranges[i] = (quad_range){begin, begin};
    for (size_t block = 0; block < count; block += whole)
        for (size_t n = block; n < block + stride; n += 4)
            extend_ranges(steps, stride, quads + n, ranges);
#pragma GCC unroll 3
    for (size_t i = 1; i < steps; i++) {
        ranges[0].low = quad_lesser(&ranges[i].low, &ranges[0].low);
        ranges[0].high = quad_larger(&ranges[i].high, &ranges[0].high);
    }
    quad_store(&ranges[0].low, low);
    quad_store(&ranges[0].high, high);
    memcpy(range->low, low, sizeof range->low);
    memcpy(range->high, high, sizeof range->high);
}

static ALWAYS_INLINE void find_ranges(const size_t order[3], const double *points, const double *factors,
                                      int from, step_range ranges[3])
{
    double quads[4 * CELL_POINTS];
    const size_t count = order[0] * order[1] * order[2];
#pragma GCC unroll 4
    for (size_t n = 0; n < count; n++) {
        const quad point = quad_load(points + 3 * n), scaled = quad_times(factors ? factors[n] : 1, &point);
        quad_store(&scaled, quads + 4 * n);
    }
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++)
        if (a >= from && order[a] > 1)
            find_range(order, a, quads, &ranges[a]);
}

void FFD_SLOPE_KERNEL(const size_t order[3], const double *points, const double *factors, int from,
                      step_range ranges[3])
{
    static const size_t cubic[3] = {4, 4, 4};
    /* Constant orders let the compiler unroll the loops. */
    if (order[0] == 4 && order[1] == 4 && order[2] == 4)
        find_ranges(cubic, points, factors, from, ranges);
    else
        find_ranges(order, points, factors, from, ranges);
}
