#include "embed/face.h"
#include "base/vec.h"

bool ffd_weigh_rows(const double jacobian[9], const double equation[3], const double tolerance[3],
                    double weighed_jacobian[9], double weighed_equation[3])
{
    double least = HUGE_VAL;
    for (int r = 0; r < 3; r++)
        if (tolerance[r] > 0)
            least = fmin(least, tolerance[r]);
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

/* Normal equations: the columns of two directions of a cell are far from parallel, or the determinant tells.
 */
static bool step_of_two(const double matrix[9], const double value[3], int a, int b, double step[3])
{
    double first[3], second[3];
    column_of(matrix, a, first);
    column_of(matrix, b, second);
    const double aa = vec_dot(first, first), ab = vec_dot(first, second), bb = vec_dot(second, second);
    const double ar = -vec_dot(first, value), br = -vec_dot(second, value), det = aa * bb - ab * ab;
    if (!(det > 0))
        return false;
    step[a] = (ar * bb - br * ab) / det;
    step[b] = (br * aa - ar * ab) / det;
    return true;
}

static bool step_of_three(const double matrix[9], const double value[3], double step[3])
{
    double inverse[9];
    if (!mat_invert(matrix, inverse))
        return false;
    mat_apply(inverse, value, step);
    for (int a = 0; a < 3; a++)
        step[a] = -step[a];
    return true;
}

bool ffd_face_step(const double jacobian[9], const double equation[3], const double tolerance[3], double t[3])
{
    double matrix[9], value[3], step[3] = {0, 0, 0};
    int moving[3], count = 0;
    if (!ffd_weigh_rows(jacobian, equation, tolerance, matrix, value))
        return false;
    for (int a = 0; a < 3; a++) {
        double column[3];
        column_of(matrix, a, column);
        const double slope = vec_dot(column, value); /* of |F|^2 / 2 */
        if ((t[a] > 0 || slope < 0) && (t[a] < 1 || slope > 0))
            moving[count++] = a;
    }
    const bool found = count == 3   ? step_of_three(matrix, value, step)
                       : count == 2 ? step_of_two(matrix, value, moving[0], moving[1], step)
                       : count == 1 ? step_of_one(matrix, value, moving[0], step)
                                    : false;
    for (int a = 0; a < 3 && found; a++)
        t[a] = clip_to_unit(t[a] + step[a]);
    return found;
}
