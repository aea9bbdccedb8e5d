/* attribute_kernel.h - transforms several normals or tangents at a time. */
#ifndef FFD_DEFORM_ATTRIBUTE_KERNEL_H
#define FFD_DEFORM_ATTRIBUTE_KERNEL_H

#include "base/vector/isa.h"
#include <ffd/deform.h>
#include <stddef.h>
#include <stdint.h>

/* The kernel has not decided on a direction: use the function for a single one. */
#define DIRECTION_OPEN FFD_DIRECTION_OUTCOMES

/* Directions, and the deformation gradients at their points. */
typedef struct attribute_batch {
    const double *gradients; /* F - I of point n begins at gradients[9 * n] */
    const uint32_t *points;  /* point of each direction; NULL: direction i belongs to point i */
    size_t count;
    double *directions; /* direction i begins at directions[i * step]: 3 numbers, modified in place */
    size_t step;
    const double *normals; /* for tangents: deformed unit normals, 3 numbers each, or NULL; for normals:
                              NULL */
    uint8_t *outcomes;     /* ffd_direction_outcome of each direction */
} attribute_batch;

/* Returns F - I at the point of direction i. */
static inline const double *attribute_gradient(const attribute_batch *batch, size_t i)
{
    return batch->gradients + 9 * (batch->points ? batch->points[i] : i);
}

/* Does what ffd_deform_normal or ffd_deform_tangent does, with the same bits, for directions whose magnitudes
   are far from overflow and underflow; the others are left open. One function for each SIMD instruction
   set. */
typedef void attribute_kernel(const attribute_batch *batch);

#define DECLARE(ISA, set, lanes) attribute_kernel ffd_normal_kernel_##set, ffd_tangent_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
