/* region_kernel.c - compiled once for each SIMD instruction set; FFD_REGION_KERNEL is the name of the
   function, FFD_LANES the number of lanes, each with one point. The operations are those of leaf.c in the
   same order, including the evaluation. A lane that is finished keeps its values while the others continue.
   Loops are unrolled as in deform/kernel.c. */
#include "embed/cells/region_kernel.h"
#include "base/vector/lanes.h"
#include <float.h>

/* As in leaf.c. */
#define LEAF_STEPS 64

static ALWAYS_INLINE lanes greatest(const lanes v[3])
{
    const lanes x = lanes_magnitude(v[0]), y = lanes_magnitude(v[1]), z = lanes_magnitude(v[2]);
    return lanes_choose(x > y, lanes_choose(x > z, x, z), lanes_choose(y > z, y, z));
}

static ALWAYS_INLINE lanes clip_to_unit(lanes t)
{
    return lanes_choose(t < 0, lanes_all(0), lanes_choose(t > 1, lanes_all(1), t));
}

/* The data of the region of each lane. */
typedef struct numbers_lanes {
    lanes lo[3], width[3], inverse[9], bound, centre[BEZIER_COMPONENTS], greatest_weight, grain;
} numbers_lanes;

static ALWAYS_INLINE void take_numbers(const cell_region *const region[REGION_LANES], numbers_lanes *numbers)
{
    for (int l = 0; l < FFD_LANES; l++) {
        const cell_region *const of = region[l];
        for (int a = 0; a < 3; a++) {
            numbers->lo[a][l] = of->lo[a];
            numbers->width[a][l] = of->width[a];
        }
        for (int i = 0; i < 9; i++)
            numbers->inverse[i][l] = of->inverse[i];
        numbers->bound[l] = of->bound;
        for (int c = 0; c < BEZIER_COMPONENTS; c++)
            numbers->centre[c][l] = of->centre[c];
        numbers->greatest_weight[l] = of->greatest_weight;
        numbers->grain[l] = of->grain;
    }
}

/* out = m v; must not be v. */
static ALWAYS_INLINE void apply(const lanes m[9], const lanes v[3], lanes out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = lanes_dot(m + 3 * r, v);
}

typedef struct basis_lanes {
    lanes value[MAX_ORDER], slope[MAX_ORDER];
} basis_lanes;

/* As raise_by in spline/basis.c. */
static ALWAYS_INLINE void raise_degree(const span_scheme *scheme, int d, int degree, lanes u, lanes *value)
{
    const double *const right = scheme->knots + d, *const left = right - degree;
    const double *const reciprocal = scheme->reciprocals + degree * (degree - 1) / 2;
    lanes from_left = lanes_all(0);
#pragma GCC unroll 4
    for (int r = 0; r < degree; r++) {
        const lanes share = value[r] * reciprocal[r];
        value[r] = from_left + (right[r] - u) * share;
        from_left = (u - left[r]) * share;
    }
    value[degree] = from_left;
}

/* As ffd_basis_derivatives_by. */
static ALWAYS_INLINE void find_basis(const span_scheme *scheme, int d, lanes offset, basis_lanes *basis)
{
    const lanes u = offset / scheme->length;
    lanes before = lanes_all(0);
    basis->value[0] = lanes_all(1);
#pragma GCC unroll 4
    for (int degree = 1; degree < d; degree++)
        raise_degree(scheme, d, degree, u, basis->value);
#pragma GCC unroll 4
    for (int r = 0; r < d; r++) {
        const lanes quotient = basis->value[r] * scheme->factors[r];
        basis->slope[r] = before - quotient;
        before = quotient;
    }
    basis->slope[d] = before;
    raise_degree(scheme, d, d, u, basis->value);
}

/* F and its derivatives by t. */
typedef struct sample_lanes {
    lanes equation[3], jacobian[9];
} sample_lanes;

static ALWAYS_INLINE void evaluate(const region_kernel_cell *cell, const int order[3],
                                   const numbers_lanes *region, const lanes x[3], const lanes t[3],
                                   sample_lanes *at)
{
    basis_lanes basis[3];
#pragma GCC unroll 3
    for (int a = 0; a < 3; a++) {
        const lanes offset = region->lo[a] + t[a] * region->width[a];
        find_basis(cell->schemes[a], order[a] - 1, offset, &basis[a]);
    }
    lanes sum[3], by[3][3];
    for (int r = 0; r < 3; r++)
        sum[r] = by[0][r] = by[1][r] = by[2][r] = lanes_all(0);
    for (int k = 0; k < order[2]; k++) {
        lanes plane[3], plane_u[3], plane_v[3];
        for (int r = 0; r < 3; r++)
            plane[r] = plane_u[r] = plane_v[r] = lanes_all(0);
        for (int j = 0; j < order[1]; j++) {
            const double *point = cell->rows[k][j];
            lanes line[3], line_u[3];
            for (int r = 0; r < 3; r++)
                line[r] = line_u[r] = lanes_all(0);
            for (int i = 0; i < order[0]; i++, point += BEZIER_COMPONENTS)
                for (int r = 0; r < 3; r++) {
                    line[r] += basis[0].value[i] * point[r];
                    line_u[r] += basis[0].slope[i] * point[r];
                }
            for (int r = 0; r < 3; r++) {
                plane[r] += basis[1].value[j] * line[r];
                plane_u[r] += basis[1].value[j] * line_u[r];
                plane_v[r] += basis[1].slope[j] * line[r];
            }
        }
        for (int r = 0; r < 3; r++) {
            sum[r] += basis[2].value[k] * plane[r];
            by[0][r] += basis[2].value[k] * plane_u[r];
            by[1][r] += basis[2].value[k] * plane_v[r];
            by[2][r] += basis[2].slope[k] * plane[r];
        }
    }
    for (int r = 0; r < 3; r++) {
        at->equation[r] = sum[r] - x[r];
        for (int a = 0; a < 3; a++)
            at->jacobian[3 * r + a] = (by[a][r] - x[r] * 0.0) * region->width[a];
    }
}

static ALWAYS_INLINE mask accepts(const sample_lanes *at, const lanes tolerance[3])
{
    mask within = (mask)(at->equation[0] <= tolerance[0]) & (at->equation[0] >= -tolerance[0]);
    for (int r = 1; r < 3; r++)
        within &= (at->equation[r] <= tolerance[r]) & (at->equation[r] >= -tolerance[r]);
    return within;
}

/* Computes t - J^{-1} F. Returns a mask of the lanes whose determinant of J can be trusted. */
static ALWAYS_INLINE mask newton_step(const sample_lanes *at, const lanes t[3], lanes to[3])
{
    const lanes *const m = at->jacobian;
    lanes c[9];
    for (int r = 0; r < 3; r++) {
        const lanes *const a = m + 3 * ((r + 1) % 3), *const b = m + 3 * ((r + 2) % 3);
        c[3 * r] = a[1] * b[2] - a[2] * b[1];
        c[3 * r + 1] = a[2] * b[0] - a[0] * b[2];
        c[3 * r + 2] = a[0] * b[1] - a[1] * b[0];
    }
    const lanes determinant = m[0] * c[0] + m[1] * c[1] + m[2] * c[2], size = lanes_magnitude(determinant);
    mask usable = (size > 1e-250) & (size < 1e250);
    for (int r = 0; r < 3; r++) {
        lanes row[3];
        for (int k = 0; k < 3; k++) {
            row[k] = c[3 * k + r] / determinant;
            usable &= lanes_magnitude(row[k]) <= DBL_MAX;
        }
        const lanes step = row[0] * at->equation[0] + row[1] * at->equation[1] + row[2] * at->equation[2];
        to[r] = clip_to_unit(t[r] + -step);
    }
    return usable;
}

/* t of each lane, and a mask of the lanes that are not finished. */
typedef struct progress {
    lanes t[3], e;
    sample_lanes at;
    mask open;
} progress;

static ALWAYS_INLINE void settle(progress *all_lanes, mask which, region_outcome outcome,
                                 region_lanes *result)
{
    which &= all_lanes->open;
    for (int l = 0; l < FFD_LANES; l++)
        if (which[l])
            result->outcome[l] = outcome;
    all_lanes->open &= ~which;
}

static ALWAYS_INLINE void move(progress *to, mask which, const lanes t[3], const sample_lanes *at)
{
    for (int a = 0; a < 3; a++) {
        to->t[a] = lanes_choose(which, t[a], to->t[a]);
        to->at.equation[a] = lanes_choose(which, at->equation[a], to->at.equation[a]);
    }
    for (int i = 0; i < 9; i++)
        to->at.jacobian[i] = lanes_choose(which, at->jacobian[i], to->at.jacobian[i]);
}

static ALWAYS_INLINE void count_evaluation(mask which, region_lanes *result)
{
    for (int l = 0; l < FFD_LANES; l++)
        result->evaluations[l] += which[l] != 0;
}

/* Values that are not finite prove nothing. */
static ALWAYS_INLINE mask is_beyond(lanes size, lanes limit)
{
    return (mask)(size > limit) & (size <= DBL_MAX);
}

/* Returns a bound of the distance to the root. */
static ALWAYS_INLINE lanes radius_at(const numbers_lanes *region, const sample_lanes *at, lanes noise)
{
    lanes image[3];
    apply(region->inverse, at->equation, image);
    return (greatest(image) + noise) / (1 - region->bound);
}

/* Makes the contraction step -Y F in the lanes in which Newton's step is not accepted. */
static ALWAYS_INLINE void contract(const region_kernel_cell *cell, const int order[3],
                                   const numbers_lanes *region, const lanes x[3], const progress *now,
                                   const lanes image[3], mask which, lanes t[3], sample_lanes *at)
{
    lanes to[3];
    sample_lanes there;
    for (int a = 0; a < 3; a++)
        to[a] = clip_to_unit(now->t[a] + -image[a]);
    evaluate(cell, order, region, x, to, &there);
    for (int a = 0; a < 3; a++) {
        t[a] = lanes_choose(which, to[a], t[a]);
        at->equation[a] = lanes_choose(which, there.equation[a], at->equation[a]);
    }
    for (int i = 0; i < 9; i++)
        at->jacobian[i] = lanes_choose(which, there.jacobian[i], at->jacobian[i]);
}

static ALWAYS_INLINE void find(const region_kernel_cell *cell, const int order[3], region_lanes *result)
{
    lanes x[3], tolerance[3], accepted[3], equation[3], step[3], image[3], t[3], noise = lanes_all(0);
    sample_lanes at;
    progress now;
    numbers_lanes region;
    take_numbers(result->region, &region);
    const lanes bound = region.bound;
    for (int a = 0; a < 3; a++) {
        x[a] = lanes_load(result->x[a]);
        tolerance[a] = lanes_load(result->tolerance[a]);
        accepted[a] = lanes_load(result->aim[a]);
        equation[a] = x[a] * region.centre[3] - region.centre[a];
    }
    for (int r = 0; r < 3; r++) {
        const lanes *const row = region.inverse + 3 * r;
        const lanes sum = (lanes_magnitude(row[0]) * tolerance[0] + lanes_magnitude(row[1]) * tolerance[1] +
                           lanes_magnitude(row[2]) * tolerance[2]) *
                          region.greatest_weight;
        noise = lanes_choose(sum > noise, sum, noise);
    }
    const lanes blur = lanes_choose(region.grain > noise, region.grain, noise);
    const lanes least = lanes_choose(4.0 * blur > 1e-12, 4.0 * blur, lanes_all(1e-12));
    now.open = ~(mask){0};
    now.e = lanes_all(0.5);
    memset(result->evaluations, 0, sizeof result->evaluations);
    apply(region.inverse, equation, step);
    settle(&now, is_beyond(greatest(step), (1 + bound) * now.e + noise), REGION_EMPTY, result);
    if (!lanes_any(now.open))
        return;
    for (int a = 0; a < 3; a++)
        now.t[a] = clip_to_unit(0.5 + step[a]);
    now.e = bound * now.e + noise;
    evaluate(cell, order, &region, x, now.t, &now.at);
    count_evaluation(now.open, result);
    for (int i = 0; i < LEAF_STEPS; i++) {
        now.e = lanes_choose(now.e > least, now.e, least);
        settle(&now, accepts(&now.at, accepted), REGION_FOUND, result);
        apply(region.inverse, now.at.equation, image);
        settle(&now, is_beyond(greatest(image), (1 + bound) * now.e + noise), REGION_EMPTY, result);
        const lanes shorter = bound * now.e + noise;
        settle(&now, ~newton_step(&now.at, now.t, t), REGION_UNCERTAIN, result);
        if (!lanes_any(now.open))
            break;
        evaluate(cell, order, &region, x, t, &at);
        count_evaluation(now.open, result);
        lanes radius = radius_at(&region, &at, noise);
        const mask slow = now.open & ~((mask)(radius <= shorter) | accepts(&at, accepted));
        if (lanes_any(slow)) {
            contract(cell, order, &region, x, &now, image, slow, t, &at);
            count_evaluation(slow, result);
            radius = lanes_choose(slow, shorter, radius);
        }
        const mask unmoved =
            ((mask)t[0] == (mask)now.t[0]) & ((mask)t[1] == (mask)now.t[1]) & ((mask)t[2] == (mask)now.t[2]);
        settle(&now, unmoved, REGION_UNCERTAIN, result);
        move(&now, now.open, t, &at);
        now.e = lanes_choose(now.open, radius, now.e);
    }
    settle(&now, now.open, REGION_UNCERTAIN, result);
    for (int a = 0; a < 3; a++) {
        memcpy(result->t[a], &now.t[a], sizeof now.t[a]);
        memcpy(result->equation[a], &now.at.equation[a], sizeof now.at.equation[a]);
    }
    for (int i = 0; i < 9; i++)
        memcpy(result->jacobian[i], &now.at.jacobian[i], sizeof now.at.jacobian[i]);
}

void FFD_REGION_KERNEL(const region_kernel_cell *cell, region_lanes *result)
{
    static const int cubic[3] = {4, 4, 4};
    /* Constant orders let the compiler unroll the loops. */
    if (cell->order[0] == 4 && cell->order[1] == 4 && cell->order[2] == 4)
        find(cell, cubic, result);
    else
        find(cell, cell->order, result);
}
