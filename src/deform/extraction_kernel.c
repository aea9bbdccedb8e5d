/* extraction_kernel.c - compiled once for each instruction set; FFD_EXTRACTION_KERNEL is the name of the
   function. It converts the control points of a cell to weighted Bezier points (NURBS Book 5.3): N_j = sum_r
   E_rj B_r, so Bezier point r in a direction is sum_j E_rj P_j, in ascending j, over the j for which E_rj can
   be other than 0 (extraction_band.h). The rows of E are weighted (bezier.h). */
#include "deform/extraction_steps.h"
#include "deform/kernel.h"
#include <stdbool.h>
#include <string.h>

/* Computes the slopes of rows of d+1 points in the same way. */
static ALWAYS_INLINE void find_point_slopes(size_t degree, size_t rows, const double *points, double *slopes)
{
    for (size_t r = 0; r < rows; r++, points += 3 * (degree + 1), slopes += 3 * degree)
        for (size_t i = 0; i < degree; i++) {
            const double up = (double)(i + 1), down = (double)(degree - i);
            const quad point = quad_load(points + 3 * i), next = quad_load(points + 3 * (i + 1));
            quad slope = quad_times(up, &next);
            quad_add(&slope, -down, &point);
            quad_store(&slope, slopes + 3 * i);
        }
}

static void extract_cubic(const double *const extraction[3], double *points)
{
    double by_u[3 * 64 + 1], by_v[3 * 64];
    for (size_t row = 0; row < 16; row++)
        combine_points(extraction[0], points + 12 * row, by_u + 12 * row);
    combine_cubic_slabs(extraction[1], 12, 3 * 64, by_u, by_v);
    combine_cubic_slabs(extraction[2], 48, 3 * 64, by_v, points);
}

static void extract(const int degree[3], const double *const extraction[3], double *points)
{
    double old[3 * CELL_POINTS];
    const size_t order[3] = {(size_t)degree[0] + 1, (size_t)degree[1] + 1, (size_t)degree[2] + 1};
    const size_t count = 3 * order[0] * order[1] * order[2];
    size_t inner = 3;
    for (int a = 0; a < 3; a++) {
        memcpy(old, points, count * sizeof *old);
        combine_slabs(extraction[a], order[a], inner, count, old, points);
        inner *= order[a];
    }
}

void FFD_EXTRACTION_KERNEL(const int degree[3], const double *const extraction[3], double *points,
                           double *slopes)
{
    const bool is_cubic = degree[0] == 3 && degree[1] == 3 && degree[2] == 3;
    if (is_cubic)
        extract_cubic(extraction, points);
    else
        extract(degree, extraction, points);
    if (slopes && is_cubic)
        find_point_slopes(3, 16, points, slopes);
    else if (slopes)
        find_point_slopes((size_t)degree[0], (size_t)(degree[1] + 1) * (size_t)(degree[2] + 1), points,
                          slopes);
}
