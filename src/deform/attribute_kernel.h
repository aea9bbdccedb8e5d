/* attribute_kernel.h - normals and tangents under deformation gradients, several at a time. */
#ifndef FFD_DEFORM_ATTRIBUTE_KERNEL_H
#define FFD_DEFORM_ATTRIBUTE_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* What has become of a direction. */
enum {
    ATTRIBUTE_KEPT,      /* it has its bits */
    ATTRIBUTE_CARRIED,   /* to another, which replaces it */
    ATTRIBUTE_COLLAPSED, /* nothing is left of it: it has its bits */
    ATTRIBUTE_OPEN       /* the kernel leaves it to the function for one */
};

/* Directions, and the points that they belong to. */
typedef struct attribute_batch {
    const double *gradients; /* F - I of point n from gradients[9 * n] on */
    const uint32_t *points;  /* of each direction; NULL: direction i belongs to point i */
    size_t count;
    double *directions; /* of direction i from directions[i * step] on: 3 numbers, changed in place */
    size_t step;
    const double *normals; /* tangents: the deformed unit normals, 3 each, that they are to be perpendicular
                              to, or NULL; normals: NULL */
    uint8_t *outcomes;     /* of each */
} attribute_batch;

/* F - I at the point of direction i. */
static inline const double *attribute_gradient(const attribute_batch *batch, size_t i)
{
    return batch->gradients + 9 * (batch->points ? batch->points[i] : i);
}

/* Does what ffd_deform_normal, or ffd_deform_tangent, does, with the same bits, for all whose sizes are far
   from the ends of the doubles' range; the others are left open. One function for each instruction set that
   has lanes. */
typedef void attribute_kernel(const attribute_batch *batch);

#ifdef FFD_X86
attribute_kernel ffd_normal_kernel_sse2, ffd_normal_kernel_avx2, ffd_normal_kernel_avx512;
attribute_kernel ffd_tangent_kernel_sse2, ffd_tangent_kernel_avx2, ffd_tangent_kernel_avx512;
#endif

#endif
