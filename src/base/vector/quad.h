/* quad.h - four doubles, such as the homogeneous coordinates of a point, for kernels that are compiled once
   for each instruction set: in one register, or in several of FFD_LANES doubles. */
#ifndef FFD_BASE_VECTOR_QUAD_H
#define FFD_BASE_VECTOR_QUAD_H

#include "base/inline.h"
#include <math.h>
#include <stdint.h>
#include <string.h>
#if FFD_LANES > 1
#if defined(__wasm_simd128__)
#include <wasm_simd128.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#else
#include <immintrin.h>
#endif
#endif

#if FFD_LANES == 1
typedef double quad_part;
#else
typedef double quad_part __attribute__((vector_size(8 * (FFD_LANES < 4 ? FFD_LANES : 4))));
typedef int64_t quad_mask __attribute__((vector_size(8 * (FFD_LANES < 4 ? FFD_LANES : 4))));
#endif

enum { QUAD_PARTS = 4 * sizeof(double) / sizeof(quad_part) };

typedef struct quad {
    quad_part part[QUAD_PARTS];
} quad;

static ALWAYS_INLINE quad quad_load(const double *numbers)
{
    quad loaded;
    memcpy(&loaded, numbers, sizeof loaded);
    return loaded;
}

static ALWAYS_INLINE void quad_store(const quad *a, double *numbers)
{
    memcpy(numbers, a, sizeof *a);
}

static ALWAYS_INLINE quad quad_times(double factor, const quad *a)
{
    quad product;
    for (int p = 0; p < QUAD_PARTS; p++)
        product.part[p] = factor * a->part[p];
    return product;
}

/* *sum += factor * term */
static ALWAYS_INLINE void quad_add(quad *sum, double factor, const quad *term)
{
    for (int p = 0; p < QUAD_PARTS; p++)
        sum->part[p] += factor * term->part[p];
}

static ALWAYS_INLINE quad quad_difference(const quad *a, const quad *b)
{
    quad difference;
    for (int p = 0; p < QUAD_PARTS; p++)
        difference.part[p] = a->part[p] - b->part[p];
    return difference;
}

static ALWAYS_INLINE quad quad_magnitude(const quad *a)
{
    quad magnitude;
    for (int p = 0; p < QUAD_PARTS; p++)
#if FFD_LANES == 1
        magnitude.part[p] = fabs(a->part[p]);
#else
        magnitude.part[p] = (quad_part)((quad_mask)a->part[p] & INT64_MAX);
#endif
    return magnitude;
}

/* a > b ? a : b and a < b ? a : b. The max and min instructions compute exactly this, but compilers do not
   use them here. They return b if neither is larger, so the result for 0 and -0, and for NaN, depends on the
   order of a and b. */
#if FFD_LANES == 1
#define QUAD_LARGER(a, b) ((a) > (b) ? (a) : (b))
#define QUAD_LESSER(a, b) ((a) < (b) ? (a) : (b))
#elif defined(__wasm_simd128__)
/* Named by its other operand: if neither is larger, the result is the first one. */
#define QUAD_LARGER(a, b) wasm_f64x2_pmax(b, a)
#define QUAD_LESSER(a, b) wasm_f64x2_pmin(b, a)
#elif defined(__aarch64__)
/* fmax and fmin order 0 and -0, and return NaN for NaN: a comparison chooses. */
#define QUAD_LARGER(a, b) vbslq_f64(vcgtq_f64(a, b), a, b)
#define QUAD_LESSER(a, b) vbslq_f64(vcltq_f64(a, b), a, b)
#elif FFD_LANES == 2
#define QUAD_LARGER(a, b) _mm_max_pd(a, b)
#define QUAD_LESSER(a, b) _mm_min_pd(a, b)
#else
#define QUAD_LARGER(a, b) _mm256_max_pd(a, b)
#define QUAD_LESSER(a, b) _mm256_min_pd(a, b)
#endif

/* a > b ? a : b for each element */
static ALWAYS_INLINE quad quad_larger(const quad *a, const quad *b)
{
    quad larger;
    for (int p = 0; p < QUAD_PARTS; p++)
        larger.part[p] = QUAD_LARGER(a->part[p], b->part[p]);
    return larger;
}

/* a < b ? a : b */
static ALWAYS_INLINE quad quad_lesser(const quad *a, const quad *b)
{
    quad lesser;
    for (int p = 0; p < QUAD_PARTS; p++)
        lesser.part[p] = QUAD_LESSER(a->part[p], b->part[p]);
    return lesser;
}

#endif
