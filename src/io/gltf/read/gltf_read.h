/* gltf_read.h - reads the elements of accessors as numbers. */
#ifndef FFD_IO_GLTF_READ_GLTF_READ_H
#define FFD_IO_GLTF_READ_GLTF_READ_H

#include "io/gltf/read/gltf_document.h"

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

#endif
