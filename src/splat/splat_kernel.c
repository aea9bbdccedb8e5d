/* splat_kernel.c - compiled once for each instruction set with lanes: FFD_POLAR_KERNEL and FFD_COLUMNS_KERNEL
   are the functions' names, FFD_LANES the number of SIMD lanes, each with one matrix. Operation by operation
   it is splat_iterations.c. */
#include "splat/splat_kernel.h"
#include "base/vector/lanes.h"

static ALWAYS_INLINE void cross(const lanes a[3], const lanes b[3], lanes out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static ALWAYS_INLINE lanes square_sum(const lanes m[9])
{
    return lanes_dot(m, m) + lanes_dot(m + 3, m + 3) + lanes_dot(m + 6, m + 6);
}

static ALWAYS_INLINE void find_nines(double (*nines)[9], double *at[FFD_LANES])
{
    for (size_t l = 0; l < FFD_LANES; l++)
        at[l] = nines[l];
}

static ALWAYS_INLINE void orthogonalise(lanes x[9])
{
    mask is_near = (mask)lanes_all(0), is_open = ~is_near;
    for (int step = 0; step < NEWTON_STEPS && lanes_any(is_open); step++) {
        lanes cofactor[9], change = lanes_all(0);
        cross(x + 3, x + 6, cofactor);
        cross(x + 6, x, cofactor + 3);
        cross(x, x + 3, cofactor + 6);
        const lanes determinant = lanes_dot(x, cofactor);
        const lanes inverse_sum = square_sum(cofactor) / (determinant * determinant);
        const lanes scale =
            lanes_choose(is_near, lanes_all(1), lanes_root(lanes_root(inverse_sum / square_sum(x))));
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

size_t FFD_POLAR_KERNEL(double (*nines)[9], size_t count)
{
    size_t first = 0;
    for (; first + FFD_LANES <= count; first += FFD_LANES) {
        double *at[FFD_LANES];
        lanes x[9];
        find_nines(nines + first, at);
        lanes_load_nines((const double *const *)at, x);
        orthogonalise(x);
        lanes_store_nines(x, at);
    }
    return first;
}

/* Returns the lanes whose columns are not perpendicular yet. */
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

size_t FFD_COLUMNS_KERNEL(double (*nines)[9], size_t count)
{
    size_t first = 0;
    for (; first + FFD_LANES <= count; first += FFD_LANES) {
        double *at[FFD_LANES];
        lanes columns[9];
        bool any = true;
        find_nines(nines + first, at);
        lanes_load_nines((const double *const *)at, columns);
        for (int sweep = 0; sweep < SWEEPS && any; sweep++) {
            mask turns = rotate(columns, columns + 3);
            turns |= rotate(columns, columns + 6);
            turns |= rotate(columns + 3, columns + 6);
            any = lanes_any(turns);
        }
        lanes_store_nines(columns, at);
    }
    return first;
}
