#include "embed/frame/slabs.h"
#include "base/vector/vec.h"
#include <string.h>

/* The share of 1e-9 is for corners, which lie on three slabs' ends but for rounding. */
static bool is_in_slabs(const slab slabs[SLABS], const double d[3])
{
    for (int i = 0; i < SLABS; i++)
        if (!(fabs(vec_dot(slabs[i].row, d) - slabs[i].middle) <= slabs[i].half * (1 + 1e-9)))
            return false;
    return true;
}

/* Adds the corners of the slabs' common part at which three slabs end. Returns their number. */
static int add_corners(const slab slabs[SLABS], const int three[3], double sum[3])
{
    double rows[9], inverse[9], ends[3], corner[3];
    int count = 0;
    for (int i = 0; i < 3; i++)
        memcpy(rows + 3 * i, slabs[three[i]].row, sizeof slabs->row);
    if (!mat_invert(rows, inverse))
        return 0;
    for (int signs = 0; signs < 8; signs++) {
        for (int i = 0; i < 3; i++)
            ends[i] = slabs[three[i]].middle + (signs >> i & 1 ? 1 : -1) * slabs[three[i]].half;
        mat_apply(inverse, ends, corner);
        if (!is_in_slabs(slabs, corner))
            continue;
        for (int a = 0; a < 3; a++)
            sum[a] += corner[a];
        count++;
    }
    return count;
}

bool ffd_slabs_find(const slab slabs[SLABS], double middle[3])
{
    double sum[3] = {0, 0, 0};
    int count = 0;
    for (int i = 0; i < SLABS; i++)
        for (int j = i + 1; j < SLABS; j++)
            for (int k = j + 1; k < SLABS; k++)
                count += add_corners(slabs, (const int[3]){i, j, k}, sum);
    for (int a = 0; a < 3 && count; a++)
        middle[a] = sum[a] / count;
    return count;
}
