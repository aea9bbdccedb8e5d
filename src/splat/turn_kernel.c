/* turn_kernel.c - compiled once for each SIMD instruction set; FFD_TURN_KERNEL is the name of the function,
   FFD_LANES the number of lanes, each with one splat. The operations are those of splat.c in the same
   order. */
#include "splat/splat_lanes.h"

static ALWAYS_INLINE void store_turn(const lanes q[4], int l, bool is_turn, bool is_mirrored,
                                     splat_turn *turn)
{
    *turn = (splat_turn){.quaternion = {1, 0, 0, 0}};
    if (!is_turn)
        return;
    for (int k = 0; k < 4; k++)
        turn->quaternion[k] = q[k][l];
    turn->is_turn = true;
    turn->is_mirrored = is_mirrored;
}

static ALWAYS_INLINE void find_turns(const double *gradients, splat_turn *turns, uint8_t *open)
{
    gradient_lanes at;
    lanes q[4];
    load_gradients(gradients, &at);
    const mask is_ordinary =
        at.is_usable & (at.is_still | ((lanes_largest_entry(at.f) >= LEAST_F) & ~at.is_flattening));
    const mask is_live = is_ordinary & ~at.is_still;
    const mask is_mirrored = lanes_dot(at.f, at.cofactor) < 0.0;
    mask is_turn = is_mirrored;
    for (int i = 0; i < 9; i++)
        at.f[i] = lanes_choose(is_live, at.f[i], lanes_all(i % 4 == 0 ? 1 : 0));
    if (lanes_any(is_live))
        orthogonalise(at.f);
    for (int i = 0; i < 9; i++)
        at.f[i] = lanes_choose(is_mirrored, -at.f[i], at.f[i]);
    find_quaternion(at.f, q);
    const mask is_negative = q[0] < 0.0;
    for (int i = 1; i < 4; i++) {
        q[i] = lanes_choose(is_negative, -q[i], q[i]);
        is_turn |= lanes_magnitude(q[i]) > NO_TURN;
    }
    q[0] = lanes_magnitude(q[0]);
    is_turn &= is_live;
    for (int l = 0; l < FFD_LANES; l++)
        if (is_ordinary[l]) {
            store_turn(q, l, is_turn[l], is_mirrored[l], &turns[l]);
            open[l] = 0;
        }
}

void FFD_TURN_KERNEL(const double *gradients, size_t count, splat_turn *turns, uint8_t *open)
{
    for (size_t i = 0; i + FFD_LANES <= count; i += FFD_LANES)
        find_turns(gradients + 9 * i, turns + i, open + i);
}
