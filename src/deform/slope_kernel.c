/* slope_kernel.c - compiled once for each instruction set; FFD_SLOPE_KERNEL is the name of the function. */
#include "deform/slope_kernel.h"
#include "base/vector/quad.h"

/* Returns the derivative by direction a from a point, of index i along it, and the next one; without the
   shift, or with it and divided by the size of coordinate `axis`. */
static ALWAYS_INLINE quad find_slope(const control_net *net, int a, size_t i, int axis, const double *points,
                                     size_t stride)
{
    const quad point = quad_load(points), next = quad_load(points + stride);
    const quad step = quad_difference(&next, &point);
    if (axis < 0)
        return quad_times(net->scale[a][i], &step);
    double numbers[4];
    quad slope = quad_load(net->shift[a]);
    quad_add(&slope, net->scale[a][i], &step);
    quad_store(&slope, numbers);
    return quad_times(1 / fabs(numbers[axis]), &slope);
}

static ALWAYS_INLINE void find_range(const control_net *net, int a, int axis, slope_range *range)
{
    const size_t *const order = net->order;
    const size_t stride = a == 0 ? 3 : a == 1 ? 3 * order[0] : 3 * order[0] * order[1];
    const size_t whole = stride * order[a], count = 3 * order[0] * order[1] * order[2];
    /* The points of the same index along a: in runs, for u in a single one. */
    const size_t from_run = a == 0 ? count : whole, from_point = a == 0 ? whole : 3;
    const size_t run = a == 0 ? count : stride;
    quad least = find_slope(net, a, 0, axis, net->points, stride), greatest = least;
    double low[4], high[4];
    for (size_t i = 0; i + 1 < order[a]; i++)
        for (size_t first = stride * i; first < count; first += from_run)
            for (size_t n = 0; n < run; n += from_point) {
                const quad slope = find_slope(net, a, i, axis, net->points + first + n, stride);
                least = quad_lesser(&slope, &least);
                greatest = quad_larger(&slope, &greatest);
            }
    quad_store(&least, low);
    quad_store(&greatest, high);
    for (int c = 0; c < 3; c++) {
        range->low[c] = axis < 0 ? low[c] + net->shift[a][c] : low[c];
        range->high[c] = axis < 0 ? high[c] + net->shift[a][c] : high[c];
    }
}

void FFD_SLOPE_KERNEL(const control_net *net, int from, const int *axes, slope_range ranges[3])
{
    /* Constant directions let the compiler find the strides. */
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++) {
        if (a < from || net->order[a] < 2)
            continue;
        if (axes)
            find_range(net, a, axes[a], &ranges[a]);
        else
            find_range(net, a, -1, &ranges[a]);
    }
}
