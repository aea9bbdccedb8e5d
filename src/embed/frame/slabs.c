#include "embed/frame/slabs.h"
#include "base/vector/vec.h"
#include <float.h>
#include <string.h>

/* All d with end[0] <= row . d <= end[1]. */
typedef struct slab {
    double row[3], end[2];
} slab;

/* Three of each parallelepiped. */
#define SLABS 6
/* The rounding of a product of a row and a corner, relative to its terms. */
#define ROUNDINGS (8 * DBL_EPSILON)
/* The least share of what is allowed is found to this. */
#define LEAST_SHARE (1.0 / 32)

/* Returns whether d is in a slab to rounding, which is less where an end is near 0, as at a face. */
static bool holds(const slab *of, const double d[3])
{
    double along = 0, size = 0;
    for (int a = 0; a < 3; a++) {
        along += of->row[a] * d[a];
        size += fabs(of->row[a] * d[a]);
    }
    return along >= of->end[0] - ROUNDINGS * (size + fabs(of->end[0])) &&
           along <= of->end[1] + ROUNDINGS * (size + fabs(of->end[1]));
}

static bool is_in_slabs(const slab slabs[SLABS], const double d[3])
{
    for (int i = 0; i < SLABS; i++)
        if (!holds(&slabs[i], d))
            return false;
    return true;
}

/* Solves rows x = ends, with one refinement, as rows of a sliver are nearly parallel. */
static void solve(const double rows[9], const double inverse[9], const double ends[3], double x[3])
{
    double left[3], more[3];
    mat_apply(inverse, ends, x);
    mat_apply(rows, x, left);
    for (int i = 0; i < 3; i++)
        left[i] = ends[i] - left[i];
    mat_apply(inverse, left, more);
    for (int a = 0; a < 3; a++)
        x[a] += more[a];
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
            ends[i] = slabs[three[i]].end[signs >> i & 1];
        solve(rows, inverse, ends, corner);
        if (!is_in_slabs(slabs, corner))
            continue;
        for (int a = 0; a < 3; a++)
            sum[a] += corner[a];
        count++;
    }
    return count;
}

/* Finds the middle of the corners of the steps of the box with |(F + J d)_a| <= share * allowed_a. Returns
   false if there are none. */
static bool find_middle(const step_box *box, const double equation[3], const double jacobian[9],
                        const double allowed[3], double share, double step[3])
{
    slab slabs[SLABS];
    double sum[3] = {0, 0, 0};
    int count = 0;
    for (int a = 0; a < 3; a++) {
        const double most = share * allowed[a];
        slabs[a] = (slab){.end = {box->least[a], box->most[a]}};
        slabs[3 + a] = (slab){.end = {-equation[a] - most, -equation[a] + most}};
        for (int b = 0; b < 3; b++) {
            slabs[a].row[b] = a == b;
            slabs[3 + a].row[b] = jacobian[3 * a + b];
        }
    }
    for (int i = 0; i < SLABS; i++)
        for (int j = i + 1; j < SLABS; j++)
            for (int k = j + 1; k < SLABS; k++)
                count += add_corners(slabs, (const int[3]){i, j, k}, sum);
    for (int a = 0; a < 3 && count; a++)
        step[a] = sum[a] / count;
    return count;
}

bool ffd_slabs_find(const step_box *box, const double equation[3], const double jacobian[9],
                    const double allowed[3], double step[3])
{
    double share = 1;
    if (!find_middle(box, equation, jacobian, allowed, share, step))
        return false;
    for (double less = 0.5; less >= LEAST_SHARE; less *= 0.5)
        if (find_middle(box, equation, jacobian, allowed, share - less, step))
            share -= less;
    return true;
}

/* Quick answers: that no rounding is needed, and that in some coordinate it is too little. */
static bool is_obvious(const double residual[3], const double jacobian[9], const double tolerance[3],
                       const double grain[3], bool *is_explained)
{
    bool within = true, beyond = false;
    for (int r = 0; r < 3; r++) {
        const double *const row = jacobian + 3 * r;
        const double jump = fabs(row[0]) * grain[0] + fabs(row[1]) * grain[1] + fabs(row[2]) * grain[2];
        within = within && fabs(residual[r]) <= tolerance[r];
        beyond = beyond || !(fabs(residual[r]) <= tolerance[r] + jump);
    }
    *is_explained = within;
    return within || beyond;
}

bool ffd_residual_is_explained(const double residual[3], const double jacobian[9], const double tolerance[3],
                               const double grain[3])
{
    const step_box box = {{-grain[0], -grain[1], -grain[2]}, {grain[0], grain[1], grain[2]}};
    double step[3];
    bool explained;
    return is_obvious(residual, jacobian, tolerance, grain, &explained)
               ? explained
               : find_middle(&box, residual, jacobian, tolerance, 1, step);
}
