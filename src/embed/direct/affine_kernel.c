/* affine_kernel.c - compiled once for each SIMD instruction set; FFD_AFFINE_KERNEL is the name of the
   function, FFD_LANES the number of lanes, each with one point. The operations are those of affine.c in the
   same order. */
#include "embed/direct/affine_kernel.h"
#include "base/vector/lanes.h"

/* The points and results of the lanes. */
typedef struct affine_lanes {
    lanes uvw[3], residual;
    mask found;
} affine_lanes;

static ALWAYS_INLINE void find(const ffd_locator *locator, const double *xyz, affine_lanes *at)
{
    const affine_map *const map = &locator->affine;
    lanes p[3], t[3], residual[3];
    lanes_load_triples(xyz, p);
    for (int a = 0; a < 3; a++)
        p[a] -= locator->origin[a];
    lanes_apply(map->inverse, p, t);
    lanes_apply(map->frame, t, residual);
    at->found = ~(mask){0};
    for (int a = 0; a < 3; a++) {
        const lanes tolerance = 16 * DBL_EPSILON * (locator->extent[a] + lanes_magnitude(p[a]));
        residual[a] -= p[a];
        at->found &= (residual[a] <= tolerance) & (residual[a] >= -tolerance) & (t[a] >= 0.0) & (t[a] <= 1.0);
    }
    /* Other magnitudes need the scaled computation of vec_length. */
    const lanes square = lanes_dot(residual, residual);
    at->found &= ((square > 1e-280) & (square < 1e300)) |
                 ((residual[0] == 0.0) & (residual[1] == 0.0) & (residual[2] == 0.0));
    at->residual = lanes_root(square);
    for (int a = 0; a < 3; a++) {
        const double lo = ffd_knots_first(&locator->lattice->knots[a]),
                     hi = ffd_knots_last(&locator->lattice->knots[a]);
        const lanes u = lo + t[a] * (hi - lo);
        at->uvw[a] = lanes_choose(u > hi, lanes_all(hi), u);
    }
}

void FFD_AFFINE_KERNEL(const ffd_locator *locator, const double *xyz, size_t count, double *uvw,
                       double *residuals, uint8_t *found)
{
    size_t first = 0;
    for (; first + FFD_LANES <= count; first += FFD_LANES) {
        affine_lanes at;
        find(locator, xyz + 3 * first, &at);
        lanes_store_triples(at.uvw, uvw + 3 * first);
        lanes_store(at.residual, residuals + first);
        for (size_t l = 0; l < FFD_LANES; l++)
            found[first + l] = (uint8_t)(at.found[l] & 1);
    }
    memset(found + first, 0, count - first);
}
