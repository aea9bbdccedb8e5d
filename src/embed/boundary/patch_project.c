/* patch_project.c - finds a local minimum of the distance from x in a patch: Newton's method for |S - x|^2 /
   2 in the square [0,1]^2. */
#include "base/vector/vec.h"
#include "embed/boundary/patch.h"
#include <float.h>
#include <string.h>

enum { N = PATCH_COMPONENTS };

#define STEPS 48
#define SHORTENINGS 24 /* the most halvings of a step */
/* Second derivatives are used if their relative determinant is at least this, else it is mostly rounding. */
#define LEAST_DETERMINANT 1e-12
/* Shorter derivatives are rounding: the patch collapses the coordinate. */
#define LEAST_SLOPE (16 * DBL_EPSILON)
/* Once steps are shorter than this, each must be at most half as long as the one before; otherwise they are
   only rounding. */
#define SHORT_STEP 1e-6

/* Raises the Bernstein polynomials of degree - 1 to those of degree, in place (NURBS Book A1.2). */
static inline void raise_bernstein(int degree, double t, double *value)
{
    const double s = 1 - t;
    value[degree] = t * value[degree - 1];
    for (int i = degree - 1; i > 0; i--)
        value[i] = s * value[i] + t * value[i - 1];
    value[0] *= s;
}

/* Evaluates the Bernstein polynomials at t with first and second derivatives, as differences of those of
   lower degree. */
static void bernstein(int order, double t, double value[3][MAX_ORDER])
{
    const int degree = order - 1;
    double *b = value[0];
    b[0] = 1;
    for (int k = 1; k <= degree - 2; k++)
        raise_bernstein(k, t, b);
    for (int i = 0; i <= degree; i++) {
        const double before = i >= 2 ? b[i - 2] : 0, at = i >= 1 && i < degree ? b[i - 1] : 0;
        const double after = i <= degree - 2 ? b[i] : 0;
        value[2][i] = degree >= 2 ? degree * (degree - 1) * (before - 2 * at + after) : 0;
    }
    if (degree >= 2)
        raise_bernstein(degree - 1, t, b);
    for (int i = 0; i <= degree; i++)
        value[1][i] = degree * ((i >= 1 ? b[i - 1] : 0) - (i < degree ? b[i] : 0));
    raise_bernstein(degree, t, b);
}

enum { VALUE, BY_S, BY_T, BY_SS, BY_ST, BY_TT, SUMS };

/* Sums A and W with their derivatives. */
static void sum_up(const face_patch *patch, const double t[2], double sum[SUMS][N])
{
    double bs[3][MAX_ORDER], bt[3][MAX_ORDER];
    bernstein(patch->order[0], t[0], bs);
    bernstein(patch->order[1], t[1], bt);
    memset(sum, 0, SUMS * sizeof *sum);
    const double *x = patch->points;
    for (int j = 0; j < patch->order[1]; j++) {
        double row[3][N] = {{0}};
        for (int i = 0; i < patch->order[0]; i++, x += N)
            for (int c = 0; c < N; c++) {
                row[0][c] += bs[0][i] * x[c];
                row[1][c] += bs[1][i] * x[c];
                row[2][c] += bs[2][i] * x[c];
            }
        for (int c = 0; c < N; c++) {
            sum[VALUE][c] += bt[0][j] * row[0][c];
            sum[BY_S][c] += bt[0][j] * row[1][c];
            sum[BY_T][c] += bt[1][j] * row[0][c];
            sum[BY_SS][c] += bt[0][j] * row[2][c];
            sum[BY_ST][c] += bt[1][j] * row[1][c];
            sum[BY_TT][c] += bt[2][j] * row[0][c];
        }
    }
}

/* Applies the quotient rule (NURBS Book 4.4). */
static void divide_by_weight(double sum[SUMS][N])
{
    const double w = sum[VALUE][3], ws = sum[BY_S][3], wt = sum[BY_T][3];
    for (int c = 0; c < 3; c++) {
        const double value = sum[VALUE][c] / w;
        const double s = (sum[BY_S][c] - value * ws) / w, t = (sum[BY_T][c] - value * wt) / w;
        sum[VALUE][c] = value;
        sum[BY_S][c] = s;
        sum[BY_T][c] = t;
        sum[BY_SS][c] = (sum[BY_SS][c] - 2 * s * ws - value * sum[BY_SS][3]) / w;
        sum[BY_ST][c] = (sum[BY_ST][c] - s * wt - t * ws - value * sum[BY_ST][3]) / w;
        sum[BY_TT][c] = (sum[BY_TT][c] - 2 * t * wt - value * sum[BY_TT][3]) / w;
    }
}

void ffd_patch_evaluate(const face_patch *patch, const double x[3], const double t[2], patch_sample *sample)
{
    double sum[SUMS][N];
    sum_up(patch, t, sum);
    if (patch->rational)
        divide_by_weight(sum);
    for (int c = 0; c < 3; c++) {
        sample->point[c] = sum[VALUE][c];
        sample->residual[c] = sum[VALUE][c] - x[c];
        sample->first[0][c] = sum[BY_S][c];
        sample->first[1][c] = sum[BY_T][c];
        sample->second[0][c] = sum[BY_SS][c];
        sample->second[1][c] = sum[BY_ST][c];
        sample->second[2][c] = sum[BY_TT][c];
    }
}

void ffd_patch_gradient(const patch_sample *sample, double gradient[2], double hessian[3])
{
    for (int f = 0; f < 2; f++)
        gradient[f] = vec_dot(sample->residual, sample->first[f]);
    for (int d = 0; d < 3; d++)
        hessian[d] = vec_dot(sample->first[d > 1], sample->first[d > 0]) +
                     vec_dot(sample->residual, sample->second[d]);
}

static double clip_within(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* Minimises the convex function gradient . step + step . hessian step / 2 with t + step in [0,1]^2. If the
   unconstrained minimum is outside, the minimum is on a side beyond which the former is. */
static void minimise_in_square(const double gradient[2], const double hessian[3], const double t[2],
                               double step[2])
{
    const double diagonal[2] = {hessian[0], hessian[2]};
    const double det = hessian[0] * hessian[2] - hessian[1] * hessian[1];
    const double whole[2] = {(hessian[1] * gradient[1] - hessian[2] * gradient[0]) / det,
                             (hessian[1] * gradient[0] - hessian[0] * gradient[1]) / det};
    double least = DBL_MAX;
    memcpy(step, whole, sizeof whole);
    for (int f = 0; f < 2; f++) {
        const double side = clip_within(whole[f], -t[f], 1 - t[f]);
        if (side == whole[f])
            continue;
        const int g = 1 - f;
        const double slope = gradient[g] + hessian[1] * side;
        const double other = clip_within(-slope / diagonal[g], -t[g], 1 - t[g]);
        const double value =
            (gradient[f] + 0.5 * diagonal[f] * side) * side + (slope + 0.5 * diagonal[g] * other) * other;
        if (value < least) {
            least = value;
            step[f] = side;
            step[g] = other;
        }
    }
}

/* Returns the second derivative by f; if it is not positive to rounding, S_f . S_f; 0 if the patch collapses
   the coordinate. */
static double second_derivative(const patch_sample *sample, int f, const double hessian[3])
{
    const double metric = vec_dot(sample->first[f], sample->first[f]);
    if (!(metric > LEAST_SLOPE * LEAST_SLOPE))
        return 0;
    return hessian[2 * f] > LEAST_DETERMINANT * metric ? hessian[2 * f] : metric;
}

static bool is_definite(const patch_sample *sample, const double hessian[3])
{
    const double det = hessian[0] * hessian[2] - hessian[1] * hessian[1];
    return hessian[0] > 0 && hessian[0] == second_derivative(sample, 0, hessian) && hessian[2] > 0 &&
           hessian[2] == second_derivative(sample, 1, hessian) &&
           det > LEAST_DETERMINANT * hessian[0] * hessian[2];
}

/* Returns whether a coordinate at an end of [0,1] is fixed there, because the distance decreases only
   outwards. */
static bool rests(double t, double gradient)
{
    return (t == 0 && gradient >= 0) || (t == 1 && gradient <= 0);
}

/* Finds the next t. Returns false if both coordinates are fixed at an end. If the second derivatives are not
   positive definite, each coordinate makes a step by itself. */
static bool next_parameters(const patch_sample *sample, const double t[2], double to[2])
{
    double gradient[2], hessian[3], step[2] = {0, 0};
    ffd_patch_gradient(sample, gradient, hessian);
    const bool held[2] = {rests(t[0], gradient[0]), rests(t[1], gradient[1])};
    if (held[0] && held[1])
        return false;
    if (!held[0] && !held[1] && is_definite(sample, hessian))
        minimise_in_square(gradient, hessian, t, step);
    else
        for (int f = 0; f < 2; f++) {
            const double second = second_derivative(sample, f, hessian);
            if (!held[f] && second > 0)
                step[f] = clip_within(-gradient[f] / second, -t[f], 1 - t[f]);
        }
    for (int f = 0; f < 2; f++)
        to[f] = clip_within(t[f] + step[f], 0, 1);
    return true;
}

/* Returns |S - x|^2 of b minus that of a, without cancellation. */
static double change_of_square(const patch_sample *a, const patch_sample *b)
{
    double sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (b->point[c] - a->point[c]) * (b->residual[c] + a->residual[c]);
    return sum;
}

void ffd_patch_project(const face_patch *patch, const double x[3], double t[2], patch_sample *sample)
{
    double last = HUGE_VAL;
    ffd_patch_evaluate(patch, x, t, sample);
    for (int round = 0; round < STEPS; round++) {
        double to[2];
        patch_sample ahead;
        if (!next_parameters(sample, t, to))
            return;
        /* Points have magnitudes of at most 1, so their rounding error is at most eps. */
        const double noise = 16 * DBL_EPSILON * vec_length(sample->residual);
        bool falls = false;
        for (int i = 0; i < SHORTENINGS && !falls; i++) {
            ffd_patch_evaluate(patch, x, to, &ahead);
            falls = change_of_square(sample, &ahead) <= noise;
            for (int f = 0; f < 2 && !falls; f++)
                to[f] = 0.5 * (t[f] + to[f]);
        }
        const double size = maximum_number(fabs(to[0] - t[0]), fabs(to[1] - t[1]));
        if (!falls || size == 0)
            return;
        memcpy(t, to, sizeof to);
        *sample = ahead;
        if (size <= DBL_EPSILON || (size < SHORT_STEP && size > 0.5 * last))
            return;
        last = size;
    }
}
