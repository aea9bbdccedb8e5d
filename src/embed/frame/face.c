#include "embed/frame/face.h"
#include "base/vector/vec.h"
#include <string.h>

/* A coordinate within this distance of an end may be fixed there. */
#define NEAR_END 1e-6
#define FACE_STEPS 5

bool ffd_weigh_rows(const double jacobian[9], const double equation[3], const double tolerance[3],
                    double weighed_jacobian[9], double weighed_equation[3])
{
    double least = HUGE_VAL;
    for (int r = 0; r < 3; r++)
        if (tolerance[r] > 0)
            least = minimum_number(least, tolerance[r]);
    if (!isfinite(least))
        return false;
    for (int r = 0; r < 3; r++) {
        const double weight = tolerance[r] > 0 ? least / tolerance[r] : 1;
        weighed_equation[r] = weight * equation[r];
        for (int a = 0; a < 3; a++)
            weighed_jacobian[3 * r + a] = weight * jacobian[3 * r + a];
    }
    return true;
}

static void column_of(const double matrix[9], int a, double column[3])
{
    for (int r = 0; r < 3; r++)
        column[r] = matrix[3 * r + a];
}

static bool step_of_one(const double matrix[9], const double value[3], int a, double step[3])
{
    double column[3];
    column_of(matrix, a, column);
    const double square = vec_dot(column, column);
    if (!(square > 0))
        return false;
    step[a] = -vec_dot(column, value) / square;
    return true;
}

/* With orthogonalised columns, because those of a sheared cell are nearly parallel. */
static bool step_of_two(const double matrix[9], const double value[3], int a, int b, double step[3])
{
    double first[3], second[3];
    column_of(matrix, a, first);
    column_of(matrix, b, second);
    const double square = vec_dot(first, first);
    if (!(square > 0))
        return false;
    const double along = vec_dot(first, second) / square;
    for (int r = 0; r < 3; r++)
        second[r] -= along * first[r];
    const double rest = vec_dot(second, second);
    if (!(rest > 0))
        return false;
    step[b] = -vec_dot(second, value) / rest;
    step[a] = -vec_dot(first, value) / square - along * step[b];
    return true;
}

/* Makes a Gauss-Newton step of the free coordinates, clamped. Returns false if there is none. */
static bool step_within(const double jacobian[9], const double equation[3], const double tolerance[3],
                        const bool rests[3], double t[3])
{
    double matrix[9], value[3], step[3] = {0, 0, 0};
    int moving[3], count = 0;
    if (!ffd_weigh_rows(jacobian, equation, tolerance, matrix, value))
        return false;
    for (int a = 0; a < 3; a++)
        if (!rests[a])
            moving[count++] = a;
    const bool found = count == 3   ? newton_step(matrix, value, step)
                       : count == 2 ? step_of_two(matrix, value, moving[0], moving[1], step)
                       : count == 1 ? step_of_one(matrix, value, moving[0], step)
                                    : false;
    for (int a = 0; a < 3 && found; a++)
        t[a] = clip_to_unit(t[a] + step[a]);
    return found;
}

static bool settle_with(const double tolerance[3], bool closest, face_function function, void *context,
                        const bool rests[3], double t[3])
{
    double jacobian[9], equation[3];
    for (int a = 0; a < 3; a++)
        if (rests[a])
            t[a] = t[a] < 0.5 ? 0 : 1;
    for (int step = 0; step < FACE_STEPS; step++) {
        const bool within = function(context, t, jacobian, equation);
        if (within && !closest)
            return true;
        if (!step_within(jacobian, equation, tolerance, rests, t))
            return within;
    }
    return function(context, t, jacobian, equation);
}

bool ffd_face_settle(const double tolerance[3], bool closest, face_function function, void *context,
                     double t[3])
{
    int near = 0;
    for (int a = 0; a < 3; a++)
        if (t[a] <= NEAR_END || t[a] >= 1 - NEAR_END)
            near |= 1 << a;
    for (int resting = 1; resting < 8; resting++) {
        const bool rests[3] = {resting & 1, resting & 2, resting & 4};
        double settled[3];
        if ((resting & near) != resting)
            continue;
        memcpy(settled, t, sizeof settled);
        if (settle_with(tolerance, closest, function, context, rests, settled)) {
            memcpy(t, settled, sizeof settled);
            return true;
        }
    }
    return false;
}
