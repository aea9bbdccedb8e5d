/* array_kernel.h - loops over arrays, compiled once for each instruction set and vectorised by the compiler.
   Each number is processed independently, so all instruction sets give the same bits. array.c selects one. */
#ifndef FFD_BASE_VECTOR_ARRAY_KERNEL_H
#define FFD_BASE_VECTOR_ARRAY_KERNEL_H

#include "base/vector/isa.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct array_kernel {
    /* Converts little-endian floats with any alignment. */
    void (*read_floats)(const unsigned char *from, size_t count, double *to);
    /* The same for unsigned 32-bit integers. Returns the largest; 0 if count is 0. */
    uint32_t (*read_u32)(const unsigned char *from, size_t count, uint32_t *to);
    /* Finds the least and the greatest of count numbers, at least one. */
    void (*span)(const uint32_t *numbers, size_t count, uint32_t *least, uint32_t *greatest);
    /* Returns the greatest magnitude of the finite ones among count numbers; 0 if there are none. */
    double (*magnitude)(const double *numbers, size_t count);
    /* Rounds to the nearest float. */
    void (*round)(const double *from, size_t count, float *to);
    /* to[i] += terms[i]; to[i] keeps its bits if terms[i] is 0. */
    void (*add)(const double *terms, size_t count, double *to);
    /* Extends the box by count points of 3 numbers. Returns true if all are finite; otherwise the box is
       unchanged. */
    bool (*widen)(const double *points, size_t count, double min[3], double max[3]);
    /* The same for points of little-endian floats with any alignment. */
    bool (*widen_floats)(const unsigned char *points, size_t count, double min[3], double max[3]);
    /* Adds a vector to each of count points of 3 numbers; a coordinate to which 0 is added keeps its bits.
       changed: count bytes, set to 1 for points whose value changes, else to 0. Returns the index of the
       first point with a changed coordinate that is NaN or greater in magnitude than `largest`; count if
       there is none. */
    size_t (*displace)(const double *vectors, size_t count, double largest, double *points, uint8_t *changed);
} array_kernel;

extern const array_kernel ffd_array_kernel_scalar;
#define DECLARE(ISA, set, lanes) extern const array_kernel ffd_array_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

/* Returns the table of an instruction set; FFD_ISA_AUTO: of the best available one. */
const array_kernel *ffd_array_kernel(ffd_isa isa);

#endif
