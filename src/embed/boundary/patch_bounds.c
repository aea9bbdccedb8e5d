/* patch_bounds.c - computes an oriented box round a patch, and bounds of its derivatives along the axes of
   the box. */
#include "base/vector/vec.h"
#include "embed/boundary/patch.h"
#include <float.h>
#include <string.h>

enum { N = PATCH_COMPONENTS };

/* If the sine of the angle between the chords of the corners is below this, they do not span a plane. */
#define LEAST_SINE 1e-10

/* Bounds of homogeneous vectors: of A and of W. */
typedef struct range {
    double lo[N], hi[N];
} range;

static const range empty_range = {{DBL_MAX, DBL_MAX, DBL_MAX, DBL_MAX},
                                  {-DBL_MAX, -DBL_MAX, -DBL_MAX, -DBL_MAX}};

static inline void range_add(range *all, const double x[N])
{
    for (int c = 0; c < N; c++) {
        all->lo[c] = x[c] < all->lo[c] ? x[c] : all->lo[c];
        all->hi[c] = x[c] > all->hi[c] ? x[c] : all->hi[c];
    }
}

static inline double greatest(double lo, double hi)
{
    return -lo > hi ? -lo : hi;
}

/* The axes */

static bool to_unit(double v[3])
{
    const double length = vec_length(v);
    if (!(length > 0))
        return false;
    for (int c = 0; c < 3; c++)
        v[c] /= length;
    return true;
}

/* Sets axis[3..5]: perpendicular to axis[0..2], towards the coordinate axis with the least component along
   that. */
static void set_second_axis(double axis[9])
{
    int least = 0;
    for (int c = 1; c < 3; c++)
        if (fabs(axis[c]) < fabs(axis[least]))
            least = c;
    for (int c = 0; c < 3; c++)
        axis[3 + c] = (c == least ? 1 : 0) - axis[least] * axis[c];
    to_unit(axis + 3);
}

static void position_of(const double *point, double position[3])
{
    for (int c = 0; c < 3; c++)
        position[c] = point[c] / point[3];
}

/* Sets the first axis along s and the last to the normal of the bilinear patch of the corners. */
static void set_axes(face_patch *patch)
{
    const size_t os = (size_t)patch->order[0], count = os * (size_t)patch->order[1];
    double corner[4][3], chord[2][3], normal[3];
    position_of(patch->points, corner[0]);
    position_of(patch->points + N * (os - 1), corner[1]);
    position_of(patch->points + N * (count - os), corner[2]);
    position_of(patch->points + N * (count - 1), corner[3]);
    for (int c = 0; c < 3; c++) {
        chord[0][c] = corner[1][c] - corner[0][c] + (corner[3][c] - corner[2][c]);
        chord[1][c] = corner[2][c] - corner[0][c] + (corner[3][c] - corner[1][c]);
    }
    const bool has[2] = {to_unit(chord[0]), to_unit(chord[1])};
    double *axis = patch->axis;
    vec_cross(chord[0], chord[1], normal);
    if (!has[0] && !has[1]) {
        const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        memcpy(axis, identity, sizeof identity);
        return;
    }
    memcpy(axis, chord[has[0] ? 0 : 1], sizeof chord[0]);
    if (has[0] && has[1] && vec_length(normal) > LEAST_SINE) {
        to_unit(normal);
        vec_cross(normal, axis, axis + 3);
    } else {
        set_second_axis(axis);
    }
    vec_cross(axis, axis + 3, axis + 6);
}

/* The box */

static void set_box(face_patch *patch)
{
    const size_t count = (size_t)patch->order[0] * (size_t)patch->order[1];
    double start[3], middle[3];
    bounds box = {{0, 0, 0}, {0, 0, 0}};
    position_of(patch->points, start);
    for (size_t i = 1; i < count; i++) {
        double position[3];
        position_of(patch->points + N * i, position);
        for (int c = 0; c < 3; c++)
            position[c] -= start[c];
        mat_apply(patch->axis, position, position);
        bounds_add(&box, position);
    }
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (box.lo[k] + box.hi[k]);
        patch->half[k] = 0.5 * (box.hi[k] - box.lo[k]);
    }
    for (int c = 0; c < 3; c++)
        patch->centre[c] = start[c] + (patch->axis[c] * middle[0] + patch->axis[3 + c] * middle[1] +
                                       patch->axis[6 + c] * middle[2]);
}

/* Derivatives */

/* The control points along the axes, relative to the centre: A - centre W. */
typedef double net[MAX_ORDER * MAX_ORDER][N];

static void make_net(const face_patch *patch, net at)
{
    const int count = patch->order[0] * patch->order[1];
    for (int i = 0; i < count; i++) {
        const double *x = patch->points + N * i;
        double off[3];
        for (int c = 0; c < 3; c++)
            off[c] = x[c] - patch->centre[c] * x[3];
        mat_apply(patch->axis, off, at[i]);
        at[i][3] = x[3];
    }
}

/* Returns bounds of the control vectors of the derivative of order n[0] by s and n[1] by t, n[0] + n[1] <= 2:
   differences of control points. */
static range derivative_range(const face_patch *patch, net at, const int n[2])
{
    const int os = patch->order[0];
    double factor = 1;
    for (int f = 0; f < 2; f++)
        for (int k = 1; k <= n[f]; k++)
            factor *= patch->order[f] - k;
    if (factor == 0)
        return (range){{0}, {0}};
    /* For n = 2 the coefficients are 1, -2, 1 on points 0, 1, 2 of a row; for (1,1) they are 1, -1, -1, 1 on
       the points of a square. */
    const bool mixed = n[0] == 1 && n[1] == 1, twice = n[0] == 2 || n[1] == 2;
    const int step = n[0] ? 1 : os, other = mixed ? os : step;
    range all = empty_range;
    for (int j = 0; j + n[1] < patch->order[1]; j++)
        for (int i = 0; i + n[0] < os; i++) {
            double(*x)[N] = at + i + os * j;
            double v[N];
            for (int c = 0; c < N; c++) {
                v[c] = x[step][c] - x[0][c];
                if (mixed || twice)
                    v[c] = x[step + other][c] - x[other][c] - v[c];
                v[c] *= factor;
            }
            range_add(&all, v);
        }
    return all;
}

/* Divides [lo - reach, hi + reach] by weights in [least, most]. */
static void divide(const range *numerator, const double reach[3], const range *weight, bounds *quotient)
{
    const double least = weight->lo[3], most = weight->hi[3];
    for (int k = 0; k < 3; k++) {
        const double lo = numerator->lo[k] - reach[k], hi = numerator->hi[k] + reach[k];
        quotient->lo[k] = lo / (lo < 0 ? least : most);
        quotient->hi[k] = hi / (hi > 0 ? least : most);
    }
}

static void copy_range(const range *from, bounds *to)
{
    memcpy(to->lo, from->lo, sizeof to->lo);
    memcpy(to->hi, from->hi, sizeof to->hi);
}

/* S_f = (A_f - S W_f)/W, S_fg = (A_fg - S_f W_g - S_g W_f - S W_fg)/W (NURBS Book 4.4), relative to the
   centre, so that |S| <= half along the axes. */
static void set_derivatives(face_patch *patch, net at)
{
    static const int order[5][2] = {{1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
    range by[5], weight = empty_range;
    for (int d = 0; d < 5; d++)
        by[d] = derivative_range(patch, at, order[d]);
    if (!patch->rational) {
        for (int d = 0; d < 5; d++)
            copy_range(&by[d], d < 2 ? &patch->first[d] : &patch->second[d - 2]);
        return;
    }
    for (int i = 0; i < patch->order[0] * patch->order[1]; i++)
        range_add(&weight, at[i]);
    double slope[5], reach[3], length[2][3];
    for (int d = 0; d < 5; d++)
        slope[d] = greatest(by[d].lo[3], by[d].hi[3]);
    for (int f = 0; f < 2; f++) {
        for (int k = 0; k < 3; k++)
            reach[k] = patch->half[k] * slope[f];
        divide(&by[f], reach, &weight, &patch->first[f]);
        for (int k = 0; k < 3; k++)
            length[f][k] = greatest(patch->first[f].lo[k], patch->first[f].hi[k]);
    }
    for (int d = 2; d < 5; d++) {
        const int f = order[d][0] ? 0 : 1, g = order[d][1] ? 1 : 0;
        for (int k = 0; k < 3; k++)
            reach[k] = length[f][k] * slope[g] + length[g][k] * slope[f] + patch->half[k] * slope[d];
        divide(&by[d], reach, &weight, &patch->second[d - 2]);
    }
}

void ffd_patch_measure(face_patch *patch)
{
    net at;
    set_axes(patch);
    set_box(patch);
    make_net(patch, at);
    set_derivatives(patch, at);
}

bounds ffd_patch_hull(const face_patch *patch)
{
    const size_t count = (size_t)patch->order[0] * (size_t)patch->order[1];
    bounds hull;
    position_of(patch->points, hull.lo);
    position_of(patch->points, hull.hi);
    for (size_t i = 1; i < count; i++) {
        double position[3];
        position_of(patch->points + N * i, position);
        bounds_add(&hull, position);
    }
    return hull;
}

/* Use */

bounds ffd_patch_residual(const face_patch *patch, const double x[3])
{
    bounds residual;
    double off[3];
    for (int c = 0; c < 3; c++)
        off[c] = patch->centre[c] - x[c];
    mat_apply(patch->axis, off, off);
    for (int k = 0; k < 3; k++) {
        residual.lo[k] = off[k] - patch->half[k];
        residual.hi[k] = off[k] + patch->half[k];
    }
    return residual;
}

/* Computes bounds of a . b. */
static void dot_range(const bounds *a, const bounds *b, double *lo, double *hi)
{
    *lo = *hi = 0;
    for (int k = 0; k < 3; k++) {
        const double p = a->lo[k] * b->lo[k], q = a->lo[k] * b->hi[k];
        const double r = a->hi[k] * b->lo[k], s = a->hi[k] * b->hi[k];
        const double least_pq = p < q ? p : q, least_rs = r < s ? r : s;
        const double most_pq = p > q ? p : q, most_rs = r > s ? r : s;
        *lo += least_pq < least_rs ? least_pq : least_rs;
        *hi += most_pq > most_rs ? most_pq : most_rs;
    }
}

/* Returns the least |a|^2. */
static double least_square(const bounds *a)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double least = a->lo[k] > 0 ? a->lo[k] : a->hi[k] < 0 ? -a->hi[k] : 0;
        sum += least * least;
    }
    return sum;
}

/* By interval bounds: if the distance is monotone in a coordinate, a minimum is at its end; in the other
   coordinates the second derivatives S_f . S_g + (S - x) . S_fg must be positive definite everywhere. */
bool ffd_patch_has_one_minimum(const face_patch *patch, const bounds *residual)
{
    double lo[3], hi[3], metric_lo, metric_hi;
    bool at_end[2];
    for (int f = 0; f < 2; f++) {
        dot_range(residual, &patch->first[f], &lo[f], &hi[f]);
        at_end[f] = lo[f] > 0 || hi[f] < 0;
    }
    for (int d = 0; d < 3; d++)
        dot_range(residual, &patch->second[d], &lo[d], &hi[d]);
    const double ss = least_square(&patch->first[0]) + lo[0];
    const double tt = least_square(&patch->first[1]) + lo[2];
    if (at_end[0] || at_end[1])
        return (at_end[0] || ss > 0) && (at_end[1] || tt > 0);
    dot_range(&patch->first[0], &patch->first[1], &metric_lo, &metric_hi);
    const double st = greatest(metric_lo + lo[1], metric_hi + hi[1]);
    return ss > 0 && tt > 0 && st * st < ss * tt * (1 - 1e-9);
}

static double greatest_length(const bounds *box)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double most = greatest(box->lo[k], box->hi[k]);
        sum += most * most;
    }
    return sqrt(sum);
}

/* Halving direction f halves the variation of S_f due to S_ff, and that of the other derivative due to
   S_st. */
int ffd_patch_direction(const face_patch *patch)
{
    const double s = greatest_length(&patch->first[0]), t = greatest_length(&patch->first[1]);
    const double mixed = greatest_length(&patch->second[1]);
    if (!(s > 0 && t > 0))
        return s > 0 ? 0 : t > 0 ? 1 : patch->hi[1] - patch->lo[1] > patch->hi[0] - patch->lo[0];
    const double along_s = greatest_length(&patch->second[0]) / s + mixed / t;
    const double along_t = greatest_length(&patch->second[2]) / t + mixed / s;
    return along_s == along_t ? t > s : along_t > along_s;
}
