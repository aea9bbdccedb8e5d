/* gltf_encode.h - numbers of a component type: rounding to a representable number, the range, the bytes of an
   element. A normalized integer q of scale s stands for q/s (glTF 2.0, 3.11), any other integer for
   itself. */
#ifndef FFD_IO_GLTF_READ_GLTF_ENCODE_H
#define FFD_IO_GLTF_READ_GLTF_ENCODE_H

#include "io/gltf/read/gltf_model.h"

#define GLTF_LARGEST_VECTOR 16  /* bytes of a VEC4 of floats */
#define GLTF_LARGEST_ELEMENT 64 /* of a MAT4 of floats */

/* Returns the representable number nearest to value, without regard to the type's range; ties go to the even
   integer. The result depends only on value and type. */
float ffd_gltf_round(const gltf_accessor *accessor, double value);

/* Returns the distance between neighbouring numbers of an integer type. */
double ffd_gltf_step(const gltf_accessor *accessor);

/* Whether the accessor's type represents all of these values exactly. */
bool ffd_gltf_fits(const gltf_accessor *accessor, const float *values, size_t count);

/* Writes the bytes of an element whose first components are values, in the accessor's type or as GLTF_FLOAT.
   The other components keep their values; in the accessor's type, unchanged components keep their bytes. */
void ffd_gltf_encode(const gltf_accessor *accessor, int component, const unsigned char *original,
                     const float *values, size_t components, unsigned char *element);

#endif
