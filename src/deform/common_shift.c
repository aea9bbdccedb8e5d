#include "deform/common_shift.h"
#include "deform/displacement_cell.h"
#include <string.h>

/* Returns the displacement of a block of the control points of a cell if all have the same one, other than 0;
   else NULL. */
static const double *shared_by(const int order[3], const function_range block[3], const double *numbers)
{
    const double *const row = numbers + 3 * (size_t)((block[2].first * order[1] + block[1].first) * order[0]);
    const double *const first = row + 3 * (size_t)block[0].first;
    if (first[0] == 0 && first[1] == 0 && first[2] == 0)
        return NULL;
    for (int k = 0; k < block[2].count; k++)
        for (int j = 0; j < block[1].count; j++)
            for (int i = 0; i < block[0].count; i++) {
                const double *const other = first + 3 * (size_t)((k * order[1] + j) * order[0] + i);
                if (other[0] != first[0] || other[1] != first[1] || other[2] != first[2])
                    return NULL;
            }
    return first;
}

static void shift(const shift_points *points, size_t i, const double shared[3])
{
    for (size_t c = 0; c < 3; c++)
        points->delta[points->step * (3 * i + c)] = shared[c];
}

/* Shifts a point on whose knots fewer control points act than in its cell. */
static void shift_on_knots(const shift_points *points, const int order[3], const double *numbers, size_t i)
{
    const double *const uvw = points->uvw + 3 * i;
    function_range block[3];
    bool is_less = false;
    for (int a = 0; a < 3; a++) {
        block[a] = ffd_displacement_acting(&points->lattice->knots[a], points->span[a], uvw[a]);
        is_less = is_less || block[a].count < order[a];
    }
    const double *const shared = is_less ? shared_by(order, block, numbers) : NULL;
    if (shared)
        shift(points, i, shared);
}

void ffd_shift_points(const shift_points *points, const double *numbers)
{
    int order[3];
    function_range all[3];
    for (int a = 0; a < 3; a++) {
        order[a] = points->lattice->knots[a].degree + 1;
        all[a] = (function_range){0, order[a]};
    }
    const double *const shared = shared_by(order, all, numbers);
    for (size_t i = 0; i < points->count && shared; i++)
        shift(points, i, shared);
    for (size_t i = 0; i < points->count && points->has_knots && !shared; i++)
        shift_on_knots(points, order, numbers, i);
}
