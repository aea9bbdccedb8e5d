/* noise.h - seeded noise with the same bits on every machine: SplitMix64 (Steele, Lea and Flood, Fast
   Splittable Pseudorandom Number Generators, 2014), whose mixing function is in the public domain. */
#ifndef FFD_LATTICE_NOISE_H
#define FFD_LATTICE_NOISE_H

#include <stddef.h>
#include <stdint.h>

/* The largest seed: every whole number up to it is a double. */
#define NOISE_MOST_SEED (((uint64_t)1 << 53) - 1)

static inline uint64_t noise_mix(uint64_t z)
{
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

/* Returns a number in [-1, 1) for an axis (0 to 2) of a control point; exact. Seeds and points are
   independent of each other. */
static inline double noise_at(uint64_t seed, size_t point, int axis)
{
    const uint64_t gamma = UINT64_C(0x9E3779B97F4A7C15);
    const uint64_t number = 3 * (uint64_t)point + (uint64_t)axis + 1;
    return (double)(noise_mix(noise_mix(seed + gamma) + number * gamma) >> 11) * 0x1p-52 - 1;
}

#endif
