/* extraction_steps.h - the steps by which control points become Bezier points, for kernels that are compiled
   once for each instruction set. */
#ifndef FFD_DEFORM_EXTRACTION_STEPS_H
#define FFD_DEFORM_EXTRACTION_STEPS_H

#include "base/vector/quad.h"
#include "deform/extraction_band.h"
#include <string.h>

/* Sets row r of `to` to sum_j E_rj (row j of `from`); rows have `inner` numbers. */
static ALWAYS_INLINE void combine_rows(const double *extraction, size_t order, size_t inner,
                                       const double *restrict from, double *restrict to)
{
    for (size_t r = 0; r < order; r++, extraction += order, to += inner) {
        const size_t first = band_first(r), last = band_last(r, order);
        for (size_t x = 0; x < inner; x++) {
            double sum = extraction[first] * from[first * inner + x];
            for (size_t j = first + 1; j <= last; j++)
                sum += extraction[j] * from[j * inner + x];
            to[x] = sum;
        }
    }
}

/* The same for rows of four numbers, of which there are four, `step` numbers apart in `to`. */
static ALWAYS_INLINE void combine_quads(const double *extraction, const quad point[4], size_t step,
                                        double *to)
{
#pragma GCC unroll 4
    for (size_t r = 0; r < 4; r++, extraction += 4) {
        const size_t first = band_first(r);
        quad sum = quad_times(extraction[first], &point[first]);
        for (size_t j = first + 1; j <= band_last(r, 4); j++)
            quad_add(&sum, extraction[j], &point[j]);
        quad_store(&sum, to + step * r);
    }
}

/* The same for single points, as quads: a point and one number after it, which the next point overwrites. */
static ALWAYS_INLINE void combine_points(const double *extraction, const double *from, double *to)
{
    quad point[4];
    for (int j = 0; j < 4; j++)
        point[j] = quad_load(from + 3 * j);
    combine_quads(extraction, point, 3, to);
}

static ALWAYS_INLINE void combine_slabs(const double *extraction, size_t order, size_t inner, size_t count,
                                        const double *restrict from, double *restrict to)
{
    for (size_t first = 0; first < count; first += order * inner)
        combine_rows(extraction, order, inner, from + first, to + first);
}

/* The same for four rows in each slab, whose inner numbers are a multiple of four. Loops over rows of any
   number would take longer than the sums. */
static ALWAYS_INLINE void combine_cubic_slabs(const double *extraction, size_t inner, size_t count,
                                              const double *restrict from, double *restrict to)
{
    double matrix[16]; /* where no sum is stored, so that it can stay in registers */
    memcpy(matrix, extraction, sizeof matrix);
    for (size_t first = 0; first < count; first += 4 * inner)
        for (size_t x = first; x < first + inner; x += 4) {
            quad column[4];
#pragma GCC unroll 4
            for (size_t j = 0; j < 4; j++)
                column[j] = quad_load(from + x + j * inner);
            combine_quads(matrix, column, inner, to + x);
        }
}

#endif
