/* array_kernel.h - loops over many numbers, compiled once for each instruction set: compilers turn them into
   SIMD. Each number is treated by itself, so that all give the same bits. array.c chooses among them. */
#ifndef FFD_BASE_VECTOR_ARRAY_KERNEL_H
#define FFD_BASE_VECTOR_ARRAY_KERNEL_H

#include "base/vector/isa.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct array_kernel {
    /* Floats as files have them: little-endian, at any address. */
    void (*read_floats)(const unsigned char *from, size_t count, double *to);
    /* Whole numbers of 32 bits, stored alike. Returns the largest; 0 of none. */
    uint32_t (*read_u32)(const unsigned char *from, size_t count, uint32_t *to);
    /* To the nearest float. */
    void (*round)(const double *from, size_t count, float *to);
    /* to[i] += terms[i]; where that is 0 the bits stay. */
    void (*add)(const double *terms, size_t count, double *to);
    /* Widens the box by count points, 3 numbers each. Returns whether all of these are
       finite; else the box stays. */
    bool (*widen)(const double *points, size_t count, double min[3], double max[3]);
    /* Adds a vector to each of count points, 3 numbers each; a coordinate to which 0 is added keeps its
       bits. changed: count bytes, 1 where a point has another value than before, else 0. Returns the
       number of the first point with a coordinate that changed and is now NaN or larger than `largest`;
       count if there is none. */
    size_t (*displace)(const double *vectors, size_t count, double largest, double *points, uint8_t *changed);
} array_kernel;

extern const array_kernel ffd_array_kernel_scalar;
#ifdef FFD_X86
extern const array_kernel ffd_array_kernel_sse2, ffd_array_kernel_avx2, ffd_array_kernel_avx512;
#endif

/* The loops of an instruction set; FFD_ISA_AUTO: of the best one that the processor has. */
const array_kernel *ffd_array_kernel(ffd_isa isa);

#endif
