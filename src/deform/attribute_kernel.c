/* attribute_kernel.c - compiled once for each SIMD instruction set: FFD_NORMAL_KERNEL and FFD_TANGENT_KERNEL
   are the names of the functions, FFD_LANES the number of lanes, each with one direction. The operations are
   those of attribute.c, in the same order. */
#include "deform/attribute_kernel.h"
#include "base/vector/lanes.h"
#include <float.h>

/* F at the points of the directions, and a mask of those with a gradient of 0. */
typedef struct gradient_lanes {
    lanes f[9];
    mask still;
} gradient_lanes;

static ALWAYS_INLINE void load_gradients(const attribute_batch *batch, size_t first, gradient_lanes *at)
{
    const double *gradient[FFD_LANES];
    lanes e[9];
    for (size_t l = 0; l < FFD_LANES; l++)
        gradient[l] = attribute_gradient(batch, first + l);
    lanes_load_nines(gradient, e);
    at->still = ~(mask){0};
    for (int i = 0; i < 9; i++) {
        at->still &= e[i] == 0.0;
        at->f[i] = e[i] + (i % 4 == 0 ? 1.0 : 0.0);
    }
}

/* Returns a mask of the lanes in which the square root gives the same bits as vec_length. */
static ALWAYS_INLINE mask is_ordinary(lanes square)
{
    return (square > 1e-280) & (square < 1e300);
}

static ALWAYS_INLINE void load_directions(const double *from, size_t step, lanes v[3])
{
    if (step == 3) {
        lanes_load_triples(from, v);
        return;
    }
    double triples[3 * FFD_LANES];
    for (size_t l = 0; l < FFD_LANES; l++)
        memcpy(triples + 3 * l, from + l * step, 3 * sizeof *triples);
    lanes_load_triples(triples, v);
}

/* Normalises and stores the transformed directions. size: magnitude of the summed terms. */
static ALWAYS_INLINE void finish(const attribute_batch *batch, size_t first, mask still,
                                 const lanes before[3], lanes size, const lanes carried[3])
{
    const lanes old_square = lanes_dot(before, before), square = lanes_dot(carried, carried);
    const lanes length = lanes_root(square);
    /* The old square plus 1 is an upper bound of the old length, so directions close to collapse are left
       open. */
    const mask is_carried = is_ordinary(old_square) & is_ordinary(square) &
                            (length > 16 * DBL_EPSILON * (size * (old_square + 1.0)));
    lanes result[3];
    for (int a = 0; a < 3; a++)
        result[a] = lanes_choose(is_carried & ~still, carried[a] / length, before[a]);
    double triples[3 * FFD_LANES];
    lanes_store_triples(result, triples);
    for (size_t l = 0; l < FFD_LANES; l++) {
        memcpy(batch->directions + (first + l) * batch->step, triples + 3 * l, 3 * sizeof *triples);
        batch->outcomes[first + l] = still[l]        ? FFD_DIRECTION_KEPT
                                     : is_carried[l] ? FFD_DIRECTION_CARRIED
                                                     : DIRECTION_OPEN;
    }
}

static void leave_open(const attribute_batch *batch, size_t first)
{
    memset(batch->outcomes + first, DIRECTION_OPEN, batch->count - first);
}

void FFD_NORMAL_KERNEL(const attribute_batch *batch)
{
    size_t first = 0;
    for (; first + FFD_LANES <= batch->count; first += FFD_LANES) {
        gradient_lanes at;
        lanes normal[3], cofactor[9], carried[3];
        load_gradients(batch, first, &at);
        load_directions(batch->directions + first * batch->step, batch->step, normal);
        for (int r = 0; r < 3; r++) {
            const lanes *const a = at.f + 3 * ((r + 1) % 3), *const b = at.f + 3 * ((r + 2) % 3);
            cofactor[3 * r] = a[1] * b[2] - a[2] * b[1];
            cofactor[3 * r + 1] = a[2] * b[0] - a[0] * b[2];
            cofactor[3 * r + 2] = a[0] * b[1] - a[1] * b[0];
        }
        for (int r = 0; r < 3; r++)
            carried[r] = lanes_dot(cofactor + 3 * r, normal);
        const lanes largest = lanes_largest_entry(at.f);
        finish(batch, first, at.still, normal, largest * largest, carried);
    }
    leave_open(batch, first);
}

void FFD_TANGENT_KERNEL(const attribute_batch *batch)
{
    size_t first = 0;
    for (; first + FFD_LANES <= batch->count; first += FFD_LANES) {
        gradient_lanes at;
        lanes tangent[3], normal[3], carried[3];
        load_gradients(batch, first, &at);
        load_directions(batch->directions + first * batch->step, batch->step, tangent);
        for (int r = 0; r < 3; r++)
            carried[r] = lanes_dot(at.f + 3 * r, tangent);
        if (batch->normals) {
            lanes_load_triples(batch->normals + 3 * first, normal);
            const lanes along = lanes_dot(carried, normal);
            for (int a = 0; a < 3; a++)
                carried[a] -= along * normal[a];
        }
        finish(batch, first, at.still, tangent, lanes_largest_entry(at.f), carried);
    }
    leave_open(batch, first);
}
