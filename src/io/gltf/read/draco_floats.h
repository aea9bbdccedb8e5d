/* draco_floats.h - dequantizes the integers of Draco data with the operations of the Draco library, in its
   order (bitstream specification 2.2, "Quantization inverse transform", "Octahedral inverse transform").

   The library's own code may be compiled to fused multiply-add, which rounds once where this code rounds
   twice: the same file would then give other bytes on some processors. */
#ifndef FFD_IO_GLTF_READ_DRACO_FLOATS_H
#define FFD_IO_GLTF_READ_DRACO_FLOATS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How the numbers of an attribute were quantized. */
typedef struct draco_quantization {
    int components;
    const float *least; /* per component */
    float range;        /* the same for all components */
    int bits;           /* 1 to 30 */
} draco_quantization;

/* Dequantizes count values of `components` integers each into as many floats. */
void ffd_draco_dequantize(const draco_quantization *quantization, const int32_t *integers, size_t count,
                          float *floats);

/* Decodes count normals to unit vectors. Each normal is a point (2 integers) on an octahedron unfolded to a
   square. bits: 2 to 30. */
void ffd_draco_unfold_normals(int bits, const int32_t *places, size_t count, float *normals);

#ifdef __cplusplus
}
#endif

#endif
