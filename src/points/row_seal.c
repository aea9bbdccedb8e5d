#include "points/row_seal.h"
#include "base/memory/memory.h"
#include "spline/refine.h"
#include <string.h>

/* Clamping changes no more than so many control points at either end. */
static size_t changed_most(int degree)
{
    return 2 * (size_t)degree + 2;
}

/* Sets which given control points are told apart: those of both ends, or all. */
static void set_width(const knot_row *given, sealed_direction *direction)
{
    const size_t most = changed_most(given->degree), n = given->points;
    direction->front = n <= 2 * most ? n : most;
    direction->back = n <= 2 * most ? n : n - most;
    direction->width = direction->front + (n - direction->back);
}

/* Refines unit vectors of the given control points: each of the sealed ones gets its shares of them. */
static ffd_status find_shares(const refine_plan *plan, sealed_direction *direction, ffd_error *error)
{
    const knot_row *const given = &plan->rows[0], *const sealed = &plan->rows[plan->count - 1];
    set_width(given, direction);
    double *const units = ffd_alloc_zero(given->points, direction->width * sizeof *units);
    direction->shares = ffd_alloc(sealed->points, direction->width * sizeof *direction->shares);
    ffd_status status;
    TRY_END(units && direction->shares ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < direction->front; i++)
        units[i * direction->width + i] = 1;
    for (size_t i = direction->back; i < given->points; i++)
        units[i * direction->width + direction->front + (i - direction->back)] = 1;
    TRY_END(ffd_refine_points(given, sealed, units, direction->width, 1, direction->shares, direction->copied,
                              error));
end:
    ffd_free(units);
    return status;
}

static ffd_status make_direction(const ffd_lattice *given, int a, sealed_direction *direction,
                                 ffd_error *error)
{
    const refine_wish wish = {.clamped = true};
    refine_plan plan;
    ffd_status status;
    TRY(ffd_refine_plan(&given->knots[a], &wish, "uvw"[a], FFD_MAX_CONTROL_POINTS, &plan, error));
    direction->points = plan.rows[plan.count - 1].points;
    direction->copied = ffd_alloc(direction->points, sizeof *direction->copied);
    TRY_END(direction->copied ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < direction->points; i++)
        direction->copied[i] = i;
    if (plan.count > 1) /* else the direction is clamped as it is */
        TRY_END(find_shares(&plan, direction, error));
end:
    ffd_refine_plan_free(&plan);
    return status;
}

ffd_status ffd_row_seal_make(const ffd_lattice *given, const ffd_lattice *sealed, int continuity,
                             unsigned faces, row_seal *made, ffd_error *error)
{
    *made = (row_seal){.sealed = sealed};
    for (int a = 0; a < 3; a++) {
        sealed_direction *const direction = &made->directions[a];
        for (int side = 0; side < 2; side++)
            direction->held[side] = faces >> (2 * a + side) & 1 ? (size_t)continuity + 1 : 0;
        direction->is_held = direction->held[0] + direction->held[1] > 0;
        if (direction->is_held)
            TRY(make_direction(given, a, direction, error));
    }
    return FFD_OK;
}

void ffd_row_seal_free(row_seal *seal)
{
    for (int a = 0; a < 3; a++) {
        ffd_free(seal->directions[a].copied);
        ffd_free(seal->directions[a].shares);
    }
    *seal = (row_seal){0};
}

/* The share that control point i of the sealed lattice has of a given one. */
static double share_of(const sealed_direction *direction, size_t i, size_t given)
{
    if (direction->copied[i] != REFINE_NEW)
        return direction->copied[i] == given;
    if (given < direction->front)
        return direction->shares[i * direction->width + given];
    return given < direction->back
               ? 0
               : direction->shares[i * direction->width + direction->front + (given - direction->back)];
}

void ffd_row_seal_factors(const sealed_direction *direction, int degree, size_t first, size_t sealed_first,
                          const double *basis, double *factors)
{
    const size_t order = (size_t)degree + 1;
    memset(factors, 0, order * sizeof *factors);
    for (size_t n = 0; n < order; n++) {
        const size_t i = sealed_first + n;
        if (i < direction->held[0] || direction->points - 1 - i < direction->held[1])
            continue;
        for (size_t k = 0; k < order; k++)
            factors[k] += basis[n] * share_of(direction, i, first + k);
    }
}
