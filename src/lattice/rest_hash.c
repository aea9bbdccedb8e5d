#include "lattice/rest_hash.h"
#include "base/little_endian.h"
#include "lattice/border.h"

/* Returns whether a rest weight differs from 1. A lattice with moved weights has an array of rest weights
   even if all are 1. */
static bool has_weights(const ffd_lattice *lattice)
{
    for (size_t i = 0; lattice->rest_weights && i < lattice->count; i++)
        if (lattice->rest_weights[i] != 1)
            return true;
    return false;
}

hash128 ffd_rest_hash(const ffd_lattice *lattice)
{
    unsigned char shape[3][5 * 8];
    hash128 knots[3], points, weights;
    hash_block blocks[8];
    size_t count = 0;
    for (int a = 0; a < 3; a++) {
        const knot_vector *k = &lattice->knots[a];
        const size_t knot_count = k->functions + (size_t)k->degree + 1;
        store_u64(shape[a], (uint64_t)k->degree);
        store_u64(shape[a] + 8, k->points);
        store_u64(shape[a] + 16, ffd_knots_closed(k));
        store_u64(shape[a] + 24, ffd_lattice_is_seam(lattice, a));
        store_u64(shape[a] + 32, knot_count);
        knots[a] = ffd_hash_doubles(k->t, knot_count);
        blocks[count++] = (hash_block){shape[a], sizeof shape[a]};
        blocks[count++] = (hash_block){&knots[a], sizeof knots[a]};
    }
    points = ffd_hash_doubles(lattice->rest, 3 * lattice->count);
    blocks[count++] = (hash_block){&points, sizeof points};
    if (has_weights(lattice)) {
        weights = ffd_hash_doubles(lattice->rest_weights, lattice->count);
        blocks[count++] = (hash_block){&weights, sizeof weights};
    }
    return ffd_hash_blocks(blocks, count);
}

static bool equal_knots(const knot_vector *a, const knot_vector *b)
{
    return a->degree == b->degree && a->points == b->points && a->functions == b->functions &&
           memcmp(a->t, b->t, (a->functions + (size_t)a->degree + 1) * sizeof *a->t) == 0;
}

bool ffd_rest_equal(const ffd_lattice *a, const ffd_lattice *b)
{
    for (int d = 0; d < 3; d++)
        if (!equal_knots(&a->knots[d], &b->knots[d]))
            return false;
    const size_t size = a->count * sizeof(double);
    if (memcmp(a->rest, b->rest, 3 * size) != 0)
        return false;
    const bool weights = has_weights(a);
    return weights == has_weights(b) && (!weights || memcmp(a->rest_weights, b->rest_weights, size) == 0);
}
