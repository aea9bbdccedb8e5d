/* gltf_elements.h - the elements of accessors as numbers: reading them, their precision, and writing numbers
   of a component type. A normalized integer q of scale s stands for q/s (glTF 2.0, 3.11), any other integer
   for itself. */
#ifndef FFD_IO_GLTF_READ_GLTF_ELEMENTS_H
#define FFD_IO_GLTF_READ_GLTF_ELEMENTS_H

#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_model.h"

/* Reads elements [first, first + count) of a readable accessor: the first `components` components of each, as
   double, contiguous. */
void ffd_gltf_read(const gltf_document *document, size_t accessor, size_t first, size_t count,
                   size_t components, double *values);

/* Reads indices [first, first + count) of a readable accessor. Values that are not valid indices become
   UINT32_MAX. Returns the largest; 0 if count is 0. */
uint32_t ffd_gltf_read_indices(const gltf_document *document, size_t accessor, size_t first, size_t count,
                               uint32_t *indices);

/* Returns the bytes of element i of a readable accessor: its sparse value, else its element in the
   bufferView, else zeros. */
const unsigned char *ffd_gltf_element(const gltf_document *document, size_t accessor, size_t i);

/* Reads the first components of an element as floats, as gltf_stream holds results; floats keep their
   bits. */
void ffd_gltf_original(const gltf_document *document, size_t accessor, size_t i, size_t components,
                       float *values);

/* Reads elements [first, first + count) like ffd_gltf_original, 3 components each. */
void ffd_gltf_originals(const gltf_document *document, size_t accessor, size_t first, size_t count,
                        float *values);

/* Decodes one component of this type (gltf_component). */
double ffd_gltf_read_number(const unsigned char *at, int component, bool normalized);

/* Reads one index of this unsigned type, of sparse.indices or of an index accessor. */
uint32_t ffd_gltf_read_index(const unsigned char *at, int component);

/* Returns the size of a component type in bytes. */
size_t ffd_gltf_component_size(int component);

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

/* Returns the rounding of a readable accessor of vectors: that of float32 or integers, or the quantization
   step of Draco or of a meshopt filter. */
mesh_rounding ffd_gltf_rounding(const gltf_document *document, size_t accessor);

#endif
