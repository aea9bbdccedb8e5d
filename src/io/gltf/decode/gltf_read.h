/* gltf_read.h - the elements of accessors as numbers. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_READ_H
#define FFD_IO_GLTF_DECODE_GLTF_READ_H

#include "io/gltf/document/gltf_document.h"

/* Reads elements [first, first + count) of a readable accessor as double: the first `components` values
   of each. */
void ffd_gltf_read(const gltf_document *document, size_t accessor, size_t first, size_t count,
                   size_t components, double *values);

/* Reads indices [first, first + count) of a readable accessor. What is no index becomes UINT32_MAX. Returns
   the largest; 0 if there are none. */
uint32_t ffd_gltf_read_indices(const gltf_document *document, size_t accessor, size_t first, size_t count,
                               uint32_t *indices);

/* Returns the bytes of element i of a readable accessor: of its sparse value, of its bufferView, or zeros. */
const unsigned char *ffd_gltf_element(const gltf_document *document, size_t accessor, size_t i);

/* Reads the first components of an element as results hold them (gltf_stream): floats bit for bit. */
void ffd_gltf_original(const gltf_document *document, size_t accessor, size_t i, size_t components,
                       float *values);

/* Reads elements [first, first + count) like ffd_gltf_original. */
void ffd_gltf_originals(const gltf_document *document, size_t accessor, size_t first, size_t count,
                        float *values);

/* Returns the number that the bytes of a component of this type (gltf_component) encode. */
double ffd_gltf_read_number(const unsigned char *at, int component, bool normalized);

/* Returns an index of this unsigned type; of sparse.indices or of an index accessor. */
uint32_t ffd_gltf_read_index(const unsigned char *at, int component);

/* Returns the number of bytes of a component type. */
size_t ffd_gltf_component_size(int component);

#endif
