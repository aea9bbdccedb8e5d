/* ellipsoid_kernel.c - compiled once for each instruction set with lanes: FFD_ELLIPSOID_KERNEL is the
   function's name, FFD_LANES the number of SIMD lanes, each with one splat. Operation by operation it is
   splat.c; what is not ordinary is left to it. */
#include "base/vector/exponential_lanes.h"
#include "splat/splat_lanes.h"
#include <float.h>

/* Several splats. */
typedef struct splat_lanes {
    lanes rotation[4], scale[3];
    lanes unit[4], old[9], parts[3], turn[4]; /* the quaternion, its matrix, the sizes, Q */
    lanes columns[9], lengths[3];
    mask is_open; /* left to the functions for one */
} splat_lanes;

static ALWAYS_INLINE void load(const splat_ellipsoid *splats, const splat_turn *turns, splat_lanes *s)
{
    for (int l = 0; l < FFD_LANES; l++) {
        for (int k = 0; k < 4; k++) {
            s->rotation[k][l] = splats[l].rotation[k];
            s->turn[k][l] = turns[l].quaternion[k];
        }
        for (int k = 0; k < 3; k++)
            s->scale[k][l] = splats[l].scale[k];
    }
}

static ALWAYS_INLINE void find_matrix(const lanes q[4], lanes m[9])
{
    const lanes w = q[0], x = q[1], y = q[2], z = q[3];
    m[0] = 1.0 - 2.0 * (y * y + z * z);
    m[1] = 2.0 * (x * y - w * z);
    m[2] = 2.0 * (x * z + w * y);
    m[3] = 2.0 * (x * y + w * z);
    m[4] = 1.0 - 2.0 * (x * x + z * z);
    m[5] = 2.0 * (y * z - w * x);
    m[6] = 2.0 * (x * z - w * y);
    m[7] = 2.0 * (y * z + w * x);
    m[8] = 1.0 - 2.0 * (x * x + y * y);
}

static ALWAYS_INLINE void multiply(const lanes a[9], const lanes b[9], lanes out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
}

static ALWAYS_INLINE lanes larger_of(lanes a, lanes b)
{
    return lanes_choose(b > a, b, a);
}

static ALWAYS_INLINE void find_unit(splat_lanes *s)
{
    lanes largest = lanes_all(0), sum = lanes_all(0);
    for (int k = 0; k < 4; k++) {
        const lanes size = lanes_magnitude(s->rotation[k]);
        s->is_open |= ~(size <= DBL_MAX);
        largest = larger_of(largest, size);
    }
    s->is_open |= largest == 0.0;
    for (int k = 0; k < 4; k++) {
        s->unit[k] = s->rotation[k] / largest;
        sum += s->unit[k] * s->unit[k];
    }
    const lanes length = lanes_root(sum);
    for (int k = 0; k < 4; k++)
        s->unit[k] /= length;
}

static ALWAYS_INLINE void find_parts(splat_lanes *s, bool is_logarithmic, int count)
{
    lanes largest = s->scale[0];
    for (int k = 0; k < count; k++) {
        s->is_open |= ~(s->scale[k] <= DBL_MAX);
        if (!is_logarithmic)
            s->is_open |= ~(s->scale[k] >= 0.0);
        largest = larger_of(largest, s->scale[k]);
    }
    s->is_open |= is_logarithmic ? largest < -DBL_MAX : ~(largest > 0.0);
    s->parts[2] = lanes_all(LEAST_PART);
    for (int k = 0; k < count; k++)
        s->parts[k] = is_logarithmic ? lanes_exp(larger_of(s->scale[k] - largest, lanes_all(LEAST_LOG)))
                                     : larger_of(s->scale[k] / largest, lanes_all(LEAST_PART));
}

/* The columns of F R S, made perpendicular and of length 1. */
static ALWAYS_INLINE void find_columns(const gradient_lanes *at, splat_lanes *s)
{
    const lanes largest = larger_of(lanes_largest_entry(at->f), lanes_all(LEAST_F));
    lanes product[9];
    find_matrix(s->unit, s->old);
    multiply(at->f, s->old, product);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            s->columns[3 * j + k] = product[3 * k + j] * s->parts[j];
    part_columns(s->columns);
    for (int j = 0; j < 3; j++) {
        lanes *const column = s->columns + 3 * j;
        const lanes square = lanes_dot(column, column), length = lanes_root(square);
        s->is_open |= ~((square > 1e-280) & (square < 1e300) & (length > NOTHING * largest * s->parts[j]));
        s->lengths[j] = length;
        for (int k = 0; k < 3; k++)
            column[k] /= length;
    }
}

/* Which columns are axes, and with which signs. */
typedef struct axes_choice {
    lanes order[3], signs[3], sum;
} axes_choice;

/* Takes an order of the columns where it fits better. */
static ALWAYS_INLINE void try_order(const lanes cosines[3][3], const int order[3], mask is_right,
                                    axes_choice *best)
{
    lanes sum = lanes_all(0), least = lanes_all(HUGE_VAL), signs[3];
    mask weakest[3] = {{0}};
    for (int i = 0; i < 3; i++) {
        const lanes cosine = cosines[i][order[i]], size = lanes_magnitude(cosine);
        const mask is_weaker = size < least;
        signs[i] = lanes_choose(cosine < 0.0, lanes_all(-1), lanes_all(1));
        is_right = ~(is_right ^ (cosine >= 0.0));
        sum += size;
        least = lanes_choose(is_weaker, size, least);
        for (int k = 0; k < i; k++)
            weakest[k] &= ~is_weaker;
        weakest[i] = is_weaker;
    }
    sum = lanes_choose(is_right, sum, sum - 2.0 * least);
    const mask is_better = sum > best->sum;
    best->sum = lanes_choose(is_better, sum, best->sum);
    for (int i = 0; i < 3; i++) {
        signs[i] = lanes_choose(~is_right & weakest[i], -signs[i], signs[i]);
        best->signs[i] = lanes_choose(is_better, signs[i], best->signs[i]);
        best->order[i] = lanes_choose(is_better, lanes_all(order[i]), best->order[i]);
    }
}

static ALWAYS_INLINE void choose_axes(const splat_lanes *s, bool is_flat, axes_choice *best)
{
    lanes turning[9], axes[9], across[3], cosines[3][3];
    find_matrix(s->turn, turning);
    multiply(turning, s->old, axes);
    cross(s->columns, s->columns + 3, across);
    const mask is_right = lanes_dot(across, s->columns + 6) > 0.0;
    *best = (axes_choice){.sum = lanes_all(-HUGE_VAL)};
    for (int i = 0; i < 3; i++) {
        best->signs[i] = lanes_all(1);
        best->order[i] = lanes_all(i);
        for (int j = 0; j < 3; j++) {
            const lanes *const u = s->columns + 3 * j;
            cosines[i][j] = axes[i] * u[0] + axes[3 + i] * u[1] + axes[6 + i] * u[2];
        }
    }
    for (int o = 0; o < (is_flat ? 2 : 6); o++)
        try_order((const lanes(*)[3])cosines, splat_orders[o], o % 2 == 0 ? is_right : ~is_right, best);
}

/* That of three values, a step apart, which is the ordered one. */
static ALWAYS_INLINE lanes pick(lanes order, const lanes *values, int step)
{
    return lanes_choose(order == 0.0, values[0], lanes_choose(order == 1.0, values[step], values[2 * step]));
}

static ALWAYS_INLINE void replace_rotation(const axes_choice *choice, splat_lanes *s)
{
    const lanes *const t = s->turn, *const u = s->unit;
    const lanes turned[4] = {t[0] * u[0] - t[1] * u[1] - t[2] * u[2] - t[3] * u[3],
                             t[0] * u[1] + t[1] * u[0] + t[2] * u[3] - t[3] * u[2],
                             t[0] * u[2] - t[1] * u[3] + t[2] * u[0] + t[3] * u[1],
                             t[0] * u[3] + t[1] * u[2] - t[2] * u[1] + t[3] * u[0]};
    lanes rotation[9], made[4], along = lanes_all(0), length = lanes_all(0);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            rotation[3 * k + i] = choice->signs[i] * pick(choice->order[i], s->columns + k, 3);
    find_quaternion(rotation, made);
    for (int k = 0; k < 4; k++) {
        along += made[k] * turned[k];
        length += s->rotation[k] * u[k];
    }
    length = lanes_choose(along < 0.0, -length, length);
    for (int k = 0; k < 4; k++)
        s->rotation[k] = length * made[k];
}

static ALWAYS_INLINE void replace_scale(const axes_choice *choice, bool is_logarithmic, int count,
                                        splat_lanes *s)
{
    lanes made[3];
    for (int i = 0; i < count; i++) {
        const lanes order = choice->order[i], from = pick(order, s->scale, 1);
        const lanes ratio = pick(order, s->lengths, 1) / pick(order, s->parts, 1);
        made[i] = is_logarithmic ? from + lanes_log(ratio) : from * ratio;
    }
    for (int i = 0; i < count; i++)
        s->scale[i] = made[i];
}

static ALWAYS_INLINE void store(const splat_lanes *s, mask is_still, splat_ellipsoid *splats,
                                uint8_t *outcomes)
{
    for (int l = 0; l < FFD_LANES; l++) {
        if (s->is_open[l])
            continue;
        outcomes[l] = is_still[l] ? SPLAT_KEPT : SPLAT_CARRIED;
        for (int k = 0; k < 4 && !is_still[l]; k++)
            splats[l].rotation[k] = s->rotation[k][l];
        for (int k = 0; k < 3 && !is_still[l]; k++)
            splats[l].scale[k] = s->scale[k][l];
    }
}

static ALWAYS_INLINE void deform(const double *gradients, const splat_turn *turns, bool is_logarithmic,
                                 bool is_flat, splat_ellipsoid *splats, uint8_t *outcomes)
{
    const int count = is_flat ? 2 : 3;
    gradient_lanes at;
    splat_lanes s = {.is_open = {0}};
    axes_choice choice;
    load_gradients(gradients, &at);
    load(splats, turns, &s);
    find_unit(&s);
    find_parts(&s, is_logarithmic, count);
    s.is_open |= ~at.is_usable | (at.is_flattening & ~at.is_still);
    if (lanes_any(~at.is_still & ~s.is_open)) {
        const mask was_open = s.is_open;
        find_columns(&at, &s);
        s.is_open = was_open | (s.is_open & ~at.is_still);
        choose_axes(&s, is_flat, &choice);
        replace_rotation(&choice, &s);
        replace_scale(&choice, is_logarithmic, count, &s);
    }
    store(&s, at.is_still, splats, outcomes);
}

void FFD_ELLIPSOID_KERNEL(const double *gradients, const splat_turn *turns, const splat_form *form,
                          size_t count, splat_ellipsoid *splats, uint8_t *outcomes)
{
    const bool is_flat = form->is_flat;
    for (size_t i = 0; i + FFD_LANES <= count; i += FFD_LANES)
        if (form->is_logarithmic)
            deform(gradients + 9 * i, turns + i, true, is_flat, splats + i, outcomes + i);
        else
            deform(gradients + 9 * i, turns + i, false, is_flat, splats + i, outcomes + i);
}
