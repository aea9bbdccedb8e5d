/* lanes.h - doubles side by side in a register, for kernels that are compiled once for each instruction set:
   FFD_LANES of them, 2, 4 or 8. */
#ifndef FFD_BASE_LANES_H
#define FFD_BASE_LANES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Only where it knows degrees and wishes can the compiler keep sums in registers. */
#define ALWAYS_INLINE inline __attribute__((always_inline))

typedef double lanes __attribute__((vector_size(8 * FFD_LANES)));
typedef int64_t mask __attribute__((vector_size(8 * FFD_LANES))); /* -1: yes, 0: no */

static ALWAYS_INLINE lanes lanes_choose(mask which, lanes yes, lanes no)
{
    return (lanes)((which & (mask)yes) | (~which & (mask)no));
}

static ALWAYS_INLINE lanes lanes_all(double value)
{
    return value - (lanes){0};
}

static ALWAYS_INLINE lanes lanes_magnitude(lanes a)
{
    return (lanes)((mask)a & INT64_MAX);
}

static ALWAYS_INLINE lanes lanes_root(lanes a)
{
    lanes root;
    for (int l = 0; l < FFD_LANES; l++)
        root[l] = sqrt(a[l]);
    return root;
}

static ALWAYS_INLINE bool lanes_any(mask which)
{
    int64_t some = 0;
    for (int l = 0; l < FFD_LANES; l++)
        some |= which[l];
    return some != 0;
}

static ALWAYS_INLINE lanes lanes_load(const double *from)
{
    lanes taken;
    memcpy(&taken, from, sizeof taken);
    return taken;
}

static ALWAYS_INLINE void lanes_store(lanes values, double *to)
{
    memcpy(to, &values, sizeof values);
}

static ALWAYS_INLINE lanes lanes_dot(const lanes a[3], const lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* out must not be v. */
static ALWAYS_INLINE void lanes_apply(const double m[9], const lanes v[3], lanes out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2];
}

/* Vectors of three that stand one behind the other, from and to a register for each coordinate. */
static ALWAYS_INLINE void lanes_load_triples(const double *from, lanes v[3])
{
    const lanes a = lanes_load(from), b = lanes_load(from + FFD_LANES), c = lanes_load(from + 2 * FFD_LANES);
#if FFD_LANES == 8
    v[0] = __builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0), c, 0, 1, 2, 3, 4,
                                   5, 10, 13);
    v[1] = __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0), c, 0, 1, 2, 3, 4,
                                   8, 11, 14);
    v[2] = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0), c, 0, 1, 2, 3, 4,
                                   9, 12, 15);
#elif FFD_LANES == 4
    v[0] = __builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 0), c, 0, 1, 2, 5);
    v[1] = __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 0), c, 0, 1, 2, 6);
    v[2] = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 0, 0), c, 0, 1, 4, 7);
#else
    v[0] = __builtin_shufflevector(a, b, 0, 3);
    v[1] = __builtin_shufflevector(a, c, 1, 2);
    v[2] = __builtin_shufflevector(b, c, 0, 3);
#endif
}

static ALWAYS_INLINE void lanes_store_triples(const lanes v[3], double *to)
{
    const lanes x = v[0], y = v[1], z = v[2];
#if FFD_LANES == 8
    const lanes a = __builtin_shufflevector(x, y, 0, 8, 0, 1, 9, 0, 2, 10),
                b = __builtin_shufflevector(x, y, 0, 3, 11, 0, 4, 12, 0, 5),
                c = __builtin_shufflevector(x, y, 13, 0, 6, 14, 0, 7, 15, 0);
    lanes_store(__builtin_shufflevector(a, z, 0, 1, 8, 3, 4, 9, 6, 7), to);
    lanes_store(__builtin_shufflevector(b, z, 10, 1, 2, 11, 4, 5, 12, 7), to + FFD_LANES);
    lanes_store(__builtin_shufflevector(c, z, 0, 13, 2, 3, 14, 5, 6, 15), to + 2 * FFD_LANES);
#elif FFD_LANES == 4
    const lanes a = __builtin_shufflevector(x, y, 0, 4, 0, 1), b = __builtin_shufflevector(x, y, 5, 0, 2, 6),
                c = __builtin_shufflevector(x, y, 0, 3, 7, 0);
    lanes_store(__builtin_shufflevector(a, z, 0, 1, 4, 3), to);
    lanes_store(__builtin_shufflevector(b, z, 0, 5, 2, 3), to + FFD_LANES);
    lanes_store(__builtin_shufflevector(c, z, 6, 1, 2, 7), to + 2 * FFD_LANES);
#else
    lanes_store(__builtin_shufflevector(x, y, 0, 2), to);
    lanes_store(__builtin_shufflevector(z, x, 0, 3), to + FFD_LANES);
    lanes_store(__builtin_shufflevector(y, z, 1, 3), to + 2 * FFD_LANES);
#endif
}

#endif
