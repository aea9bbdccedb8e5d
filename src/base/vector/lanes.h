/* lanes.h - a SIMD register of FFD_LANES doubles (2, 4 or 8), for kernels that are compiled once for each
   instruction set. */
#ifndef FFD_BASE_VECTOR_LANES_H
#define FFD_BASE_VECTOR_LANES_H

#include "base/inline.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef double lanes __attribute__((vector_size(8 * FFD_LANES)));
typedef int64_t mask __attribute__((vector_size(8 * FFD_LANES))); /* -1: true, 0: false */

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

/* Returns the largest magnitude of the entries of a matrix, in each lane. */
static ALWAYS_INLINE lanes lanes_largest_entry(const lanes m[9])
{
    lanes largest = lanes_all(0);
    for (int i = 0; i < 9; i++) {
        const lanes size = lanes_magnitude(m[i]);
        largest = lanes_choose(size > largest, size, largest);
    }
    return largest;
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

/* out = m v, in each lane. out must not be v. */
static ALWAYS_INLINE void lanes_apply(const double m[9], const lanes v[3], lanes out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2];
}

/* Transposes a square matrix in place. */
static ALWAYS_INLINE void lanes_transpose(lanes row[FFD_LANES])
{
#if FFD_LANES == 8
    lanes pair[8], four[8];
    for (int i = 0; i < 8; i += 2) {
        pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int i = 0; i < 8; i += 4)
        for (int c = 0; c < 2; c++) {
            four[i + c] = __builtin_shufflevector(pair[i + c], pair[i + 2 + c], 0, 1, 8, 9, 4, 5, 12, 13);
            four[i + 2 + c] =
                __builtin_shufflevector(pair[i + c], pair[i + 2 + c], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int c = 0; c < 4; c++) {
        row[c] = __builtin_shufflevector(four[c], four[4 + c], 0, 1, 2, 3, 8, 9, 10, 11);
        row[4 + c] = __builtin_shufflevector(four[c], four[4 + c], 4, 5, 6, 7, 12, 13, 14, 15);
    }
#elif FFD_LANES == 4
    lanes pair[4];
    for (int i = 0; i < 4; i += 2) {
        pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 4, 2, 6);
        pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 5, 3, 7);
    }
    for (int c = 0; c < 2; c++) {
        row[c] = __builtin_shufflevector(pair[c], pair[2 + c], 0, 1, 4, 5);
        row[2 + c] = __builtin_shufflevector(pair[c], pair[2 + c], 2, 3, 6, 7);
    }
#else
    const lanes first = __builtin_shufflevector(row[0], row[1], 0, 2);
    row[1] = __builtin_shufflevector(row[0], row[1], 1, 3);
    row[0] = first;
#endif
}

/* Loads and stores nine numbers for each of FFD_LANES points: v[i] holds number i of all points. */
static ALWAYS_INLINE void lanes_load_nines(const double *const from[FFD_LANES], lanes v[9])
{
    for (int first = 0; first < 8; first += FFD_LANES) {
        for (int l = 0; l < FFD_LANES; l++)
            v[first + l] = lanes_load(from[l] + first);
        lanes_transpose(v + first);
    }
    double last[FFD_LANES];
    for (int l = 0; l < FFD_LANES; l++)
        last[l] = from[l][8];
    v[8] = lanes_load(last);
}

static ALWAYS_INLINE void lanes_store_nines(const lanes v[9], double *const to[FFD_LANES])
{
    for (int first = 0; first < 8; first += FFD_LANES) {
        lanes row[FFD_LANES];
        for (int l = 0; l < FFD_LANES; l++)
            row[l] = v[first + l];
        lanes_transpose(row);
        for (int l = 0; l < FFD_LANES; l++)
            lanes_store(row[l], to[l] + first);
    }
    for (int l = 0; l < FFD_LANES; l++)
        to[l][8] = v[8][l];
}

/* Loads and stores FFD_LANES consecutive triples: v[i] holds coordinate i of all points. */
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
