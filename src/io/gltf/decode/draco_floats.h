/* draco_floats.h - from the integers of Draco data back to floats, with the operations of the Draco library
   in its order (bitstream specification 2.2, "Quantization inverse transform", "Octahedral inverse
   transform").

   The library does it too, but it is compiled elsewhere: to fused operations on some processors, which round
   once where these round twice, so that one file would give other bytes there. */
#ifndef FFD_IO_GLTF_DECODE_DRACO_FLOATS_H
#define FFD_IO_GLTF_DECODE_DRACO_FLOATS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the numbers of an attribute were quantized by. */
typedef struct draco_quantization {
    int components;
    const float *least; /* per component */
    float range;        /* the same for all components */
    int bits;           /* 1 to 30 */
} draco_quantization;

/* Writes the floats of count values, of as many integers each as they have components. */
void ffd_draco_dequantize(const draco_quantization *quantization, const int32_t *integers, size_t count,
                          float *floats);

/* Writes the unit vectors of count normals, of which each is a place (2 integers) on an octahedron that is
   unfolded to a square. bits: 2 to 30. */
void ffd_draco_unfold_normals(int bits, const int32_t *places, size_t count, float *normals);

#ifdef __cplusplus
}
#endif

#endif
