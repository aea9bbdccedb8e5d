/* splat_lanes.h - the iterations and helpers of the splat kernels, with one splat in each lane. The
   operations are those of splat.c in the same order. Included by the kernels only. */
#ifndef FFD_SPLAT_SPLAT_LANES_H
#define FFD_SPLAT_SPLAT_LANES_H

#include "base/vector/lanes.h"
#include "splat/splat_kernel.h"

static ALWAYS_INLINE void cross(const lanes a[3], const lanes b[3], lanes out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static ALWAYS_INLINE void find_cofactor(const lanes m[9], lanes cofactor[9])
{
    cross(m + 3, m + 6, cofactor);
    cross(m + 6, m, cofactor + 3);
    cross(m, m + 3, cofactor + 6);
}

static ALWAYS_INLINE lanes lanes_square_sum(const lanes m[9])
{
    return lanes_dot(m, m) + lanes_dot(m + 3, m + 3) + lanes_dot(m + 6, m + 6);
}

/* Returns the scale that moves a matrix towards its orthogonal factor. */
static ALWAYS_INLINE lanes find_scale(const lanes x[9], const lanes cofactor[9], lanes determinant)
{
    const lanes inverse_sum = lanes_square_sum(cofactor) / (determinant * determinant);
    return lanes_root(lanes_root(inverse_sum / lanes_square_sum(x)));
}

static ALWAYS_INLINE void orthogonalise(lanes x[9])
{
    mask is_near = (mask)lanes_all(0), is_open = ~is_near;
    for (int step = 0; step < NEWTON_STEPS && lanes_any(is_open); step++) {
        lanes cofactor[9], change = lanes_all(0);
        find_cofactor(x, cofactor);
        const lanes determinant = lanes_dot(x, cofactor);
        const lanes scale = lanes_any(is_open & ~is_near)
                                ? lanes_choose(is_near, lanes_all(1), find_scale(x, cofactor, determinant))
                                : lanes_all(1);
        const lanes back = 1.0 / (determinant * scale);
        for (int i = 0; i < 9; i++) {
            const lanes next = 0.5 * (scale * x[i] + cofactor[i] * back);
            change += (next - x[i]) * (next - x[i]);
            x[i] = lanes_choose(is_open, next, x[i]);
        }
        is_near |= change < NEWTON_NEAR;
        is_open &= ~(change < NEWTON_ENOUGH);
    }
}

/* Returns a mask of the lanes whose columns were not perpendicular. */
static ALWAYS_INLINE mask rotate(lanes p[3], lanes q[3])
{
    const lanes a = lanes_dot(p, p), b = lanes_dot(q, q), off = lanes_dot(p, q);
    const mask turns = off * off > RIGHT * RIGHT * a * b;
    if (!lanes_any(turns))
        return turns;
    const lanes tau = (b - a) / (2.0 * off);
    const lanes t = lanes_choose(tau >= 0.0, lanes_all(1), lanes_all(-1)) /
                    (lanes_magnitude(tau) + lanes_root(1.0 + tau * tau));
    const lanes c = 1.0 / lanes_root(1.0 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const lanes x = p[k], y = q[k];
        p[k] = lanes_choose(turns, c * x - s * y, x);
        q[k] = lanes_choose(turns, s * x + c * y, y);
    }
    return turns;
}

/* Processes two matrices alternately: a rotation is a chain of square roots and divisions, and their latency
   is hidden by work on the other matrix. */
static ALWAYS_INLINE void part_columns(lanes a[9], lanes b[9])
{
    bool any = true;
    for (int sweep = 0; sweep < SWEEPS && any; sweep++) {
        mask turns = rotate(a, a + 3);
        turns |= rotate(b, b + 3);
        turns |= rotate(a, a + 6);
        turns |= rotate(b, b + 6);
        turns |= rotate(a + 3, a + 6);
        turns |= rotate(b + 3, b + 6);
        any = lanes_any(turns);
    }
}

/* F of the splats in the lanes. */
typedef struct gradient_lanes {
    lanes f[9], cofactor[9];
    mask is_usable, is_still; /* masks: entries of F can be squared; the gradient is 0 to rounding */
    mask is_flattening;
} gradient_lanes;

static ALWAYS_INLINE void load_gradients(const double *gradients, gradient_lanes *at)
{
    const double *from[FFD_LANES];
    lanes e[9];
    for (size_t l = 0; l < FFD_LANES; l++)
        from[l] = gradients + 9 * l;
    lanes_load_nines(from, e);
    const lanes largest = lanes_largest_entry(e);
    at->is_usable = largest <= LARGEST_F;
    at->is_still = largest <= STILL;
    for (int r = 0; r < 9; r += 3)
        at->is_usable &= 0.0 * e[r] + 0.0 * e[r + 1] + 0.0 * e[r + 2] == 0.0;
    for (int i = 0; i < 9; i++)
        at->f[i] = e[i] + (i % 4 == 0 ? 1.0 : 0.0);
    find_cofactor(at->f, at->cofactor);
    at->is_flattening = ~(lanes_magnitude(lanes_dot(at->f, at->cofactor)) >
                          NOTHING * lanes_largest_entry(at->f) * lanes_root(lanes_square_sum(at->cofactor)));
}

/* As find_quaternion in splat.c. */
static ALWAYS_INLINE void find_quaternion(const lanes m[9], lanes q[4])
{
    const lanes trace = m[0] + m[4] + m[8], w = m[7] - m[5], x = m[2] - m[6], y = m[3] - m[1];
    const lanes a = m[1] + m[3], b = m[2] + m[6], c = m[5] + m[7];
    const lanes size[3] = {m[0], m[4], m[8]};
    const lanes choices[3][4] = {{w, 1.0 + m[0] - m[4] - m[8], a, b},
                                 {x, a, 1.0 - m[0] + m[4] - m[8], c},
                                 {y, b, c, 1.0 - m[0] - m[4] + m[8]}};
    lanes largest = trace;
    q[0] = 1.0 + trace, q[1] = w, q[2] = x, q[3] = y;
    for (int i = 0; i < 3; i++) {
        const mask is_larger = size[i] > largest;
        largest = lanes_choose(is_larger, size[i], largest);
        for (int k = 0; k < 4; k++)
            q[k] = lanes_choose(is_larger, choices[i][k], q[k]);
    }
    const lanes length = lanes_root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] /= length;
}

#endif
