/* gltf_encode.h - numbers of a component type: rounding to what it represents, its range, an element's bytes.
   A normalized integer q of scale s encodes q/s (glTF 2.0, 3.11), other integers encode themselves. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_ENCODE_H
#define FFD_IO_GLTF_DECODE_GLTF_ENCODE_H

#include "io/gltf/model/gltf_model.h"

#define GLTF_LARGEST_VECTOR 16  /* bytes of a VEC4 of floats */
#define GLTF_LARGEST_ELEMENT 64 /* of a MAT4 of floats */

/* Returns the number nearest to value that the type represents, or would with a larger range; ties go
   to the even integer. The result depends only on value and type. */
float ffd_gltf_round(const gltf_accessor *accessor, double value);

/* Returns the step between the numbers that the type, of integers, represents. */
double ffd_gltf_step(const gltf_accessor *accessor);

/* Whether the accessor's type represents all of these results exactly. */
bool ffd_gltf_fits(const gltf_accessor *accessor, const float *values, size_t count);

/* Writes the bytes of an element with values as its first components, in the accessor's type or as
   GLTF_FLOAT. Other components stay, and in the accessor's type so do the bytes of a component whose
   value is unchanged. */
void ffd_gltf_encode(const gltf_accessor *accessor, int component, const unsigned char *original,
                     const float *values, size_t components, unsigned char *element);

#endif
