/* gltf_encode.h - numbers of a component type: rounding to its steps, its range, an element's bytes. A
   normalized integer q of scale s stands for q/s (glTF 2.0, 3.11), other integers for themselves. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_ENCODE_H
#define FFD_IO_GLTF_DECODE_GLTF_ENCODE_H

#include "io/gltf/model/gltf_model.h"

#define GLTF_LARGEST_VECTOR 16 /* bytes of a VEC4 of floats */

/* The number nearest to value that the type has, or would have with a larger range; of two as near the one
   whose integer is even. It depends on nothing but value and type. */
float ffd_gltf_round(const gltf_accessor *accessor, double value);

/* Whether the accessor's type holds all of these results exactly. */
bool ffd_gltf_fits(const gltf_accessor *accessor, const float *values, size_t count);

/* The bytes of an element whose first 3 components become values, in the accessor's type or as GLTF_FLOAT;
   the others stay, and in its own type so does each component that equals what it was. */
void ffd_gltf_encode(const gltf_accessor *accessor, int component, const unsigned char *original,
                     const float values[3], unsigned char *element);

#endif
