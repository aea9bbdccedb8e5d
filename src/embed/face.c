#include "embed/face.h"
#include "base/vec.h"

bool ffd_face_step(const double jacobian[9], const double equation[3], double t[3])
{
    double column[2][3];
    int free[3], count = 0;
    for (int a = 0; a < 3; a++)
        if (t[a] > 0 && t[a] < 1)
            free[count++] = a;
    if (count != 1 && count != 2)
        return false;
    for (int c = 0; c < count; c++)
        for (int r = 0; r < 3; r++)
            column[c][r] = jacobian[3 * r + free[c]];
    /* Normal equations: the columns of two directions of a cell are far from parallel, or the determinant
     * tells. */
    const double aa = vec_dot(column[0], column[0]), ar = -vec_dot(column[0], equation);
    if (count == 1) {
        if (!(aa > 0))
            return false;
        t[free[0]] = clip_to_unit(t[free[0]] + ar / aa);
        return true;
    }
    const double ab = vec_dot(column[0], column[1]), bb = vec_dot(column[1], column[1]);
    const double br = -vec_dot(column[1], equation), det = aa * bb - ab * ab;
    if (!(det > 0))
        return false;
    t[free[0]] = clip_to_unit(t[free[0]] + (ar * bb - br * ab) / det);
    t[free[1]] = clip_to_unit(t[free[1]] + (br * aa - ar * ab) / det);
    return true;
}
