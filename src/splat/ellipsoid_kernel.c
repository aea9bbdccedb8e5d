/* ellipsoid_kernel.c - compiled once for each SIMD instruction set; FFD_ELLIPSOID_KERNEL is the name of the
   function, FFD_LANES the number of lanes, each with one splat. The operations are those of splat.c in the
   same order; special cases are left to splat.c. */
#include "base/vector/exponential_lanes.h"
#include "splat/splat_lanes.h"
#include <float.h>

typedef lanes number;
#include "splat/quaternion_matrix.h"

/* The splats of the lanes. */
typedef struct splat_lanes {
    lanes rotation[4], scale[3];
    lanes unit[4], old[9], parts[3], turn[4]; /* the unit quaternion, its matrix, the scales, and the rotation
                                                 of F */
    lanes columns[9], lengths[3];
    mask is_open; /* left to splat.c */
} splat_lanes;

static ALWAYS_INLINE void load(const splat_ellipsoid *splats, const splat_turn *turns, splat_lanes *s)
{
    double rotation[4][FFD_LANES], turn[4][FFD_LANES], scale[3][FFD_LANES];
    for (int l = 0; l < FFD_LANES; l++) {
        for (int k = 0; k < 4; k++) {
            rotation[k][l] = splats[l].rotation[k];
            turn[k][l] = turns[l].quaternion[k];
        }
        for (int k = 0; k < 3; k++)
            scale[k][l] = splats[l].scale[k];
    }
    memcpy(s->rotation, rotation, sizeof rotation);
    memcpy(s->turn, turn, sizeof turn);
    memcpy(s->scale, scale, sizeof scale);
    s->is_open = (mask){0};
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

/* Computes the columns of F R S. */
static ALWAYS_INLINE void find_columns(const gradient_lanes *at, splat_lanes *s)
{
    lanes product[9];
    find_matrix(s->unit, s->old);
    multiply(at->f, s->old, product);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            s->columns[3 * j + k] = product[3 * k + j] * s->parts[j];
}

/* Normalises the columns. */
static ALWAYS_INLINE void find_lengths(const gradient_lanes *at, splat_lanes *s)
{
    const lanes largest = larger_of(lanes_largest_entry(at->f), lanes_all(LEAST_F));
    for (int j = 0; j < 3; j++) {
        lanes *const column = s->columns + 3 * j;
        const lanes square = lanes_dot(column, column), length = lanes_root(square);
        s->is_open |= ~((square > 1e-280) & (square < 1e300) & (length > NOTHING * largest * s->parts[j]));
        s->lengths[j] = length;
        for (int k = 0; k < 3; k++)
            column[k] /= length;
    }
}

/* The assignment of columns to axes, and their signs. */
typedef struct axes_choice {
    lanes order[3], signs[3], sum;
} axes_choice;

/* Takes an order of the columns in the lanes in which it fits better. */
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

/* Selects one of three values, `step` apart, by index. */
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

/* The part before the iteration. */
static ALWAYS_INLINE void begin(const double *gradients, const splat_turn *turns, const splat_form *form,
                                const splat_ellipsoid *splats, gradient_lanes *at, splat_lanes *s)
{
    load_gradients(gradients, at);
    load(splats, turns, s);
    find_unit(s);
    find_parts(s, form->is_logarithmic, form->is_flat ? 2 : 3);
    s->is_open |= ~at->is_usable | (at->is_flattening & ~at->is_still);
}

/* The part after the iteration. */
static ALWAYS_INLINE void finish(const gradient_lanes *at, const splat_form *form, splat_lanes *s)
{
    const mask was_open = s->is_open;
    axes_choice choice;
    find_lengths(at, s);
    s->is_open = was_open | (s->is_open & ~at->is_still);
    choose_axes(s, form->is_flat, &choice);
    replace_rotation(&choice, s);
    replace_scale(&choice, form->is_logarithmic, form->is_flat ? 2 : 3, s);
}

/* Number of splats in two registers. */
#define PAIR (2 * (size_t)FFD_LANES)

static ALWAYS_INLINE void deform_pair(const double *gradients, const splat_turn *turns,
                                      const splat_form *form, splat_ellipsoid *splats, uint8_t *outcomes)
{
    gradient_lanes at[2];
    splat_lanes s[2];
    for (size_t i = 0; i < 2; i++)
        begin(gradients + 9 * i * FFD_LANES, turns + i * FFD_LANES, form, splats + i * FFD_LANES, &at[i],
              &s[i]);
    if (lanes_any((~at[0].is_still & ~s[0].is_open) | (~at[1].is_still & ~s[1].is_open))) {
        for (int i = 0; i < 2; i++)
            find_columns(&at[i], &s[i]);
        part_columns(s[0].columns, s[1].columns);
        for (int i = 0; i < 2; i++)
            finish(&at[i], form, &s[i]);
    }
    for (size_t i = 0; i < 2; i++)
        store(&s[i], at[i].is_still, splats + i * FFD_LANES, outcomes + i * FFD_LANES);
}

static ALWAYS_INLINE void deform(const double *gradients, const splat_turn *turns, const splat_form *form,
                                 size_t count, splat_ellipsoid *splats, uint8_t *outcomes)
{
    for (size_t i = 0; i + PAIR <= count; i += PAIR)
        deform_pair(gradients + 9 * i, turns + i, form, splats + i, outcomes + i);
}

void FFD_ELLIPSOID_KERNEL(const double *gradients, const splat_turn *turns, const splat_form *form,
                          size_t count, splat_ellipsoid *splats, uint8_t *outcomes)
{
    const splat_form logarithmic = {.is_logarithmic = true, .is_flat = form->is_flat};
    const splat_form linear = {.is_logarithmic = false, .is_flat = form->is_flat};
    if (form->is_logarithmic)
        deform(gradients, turns, &logarithmic, count, splats, outcomes);
    else
        deform(gradients, turns, &linear, count, splats, outcomes);
}
