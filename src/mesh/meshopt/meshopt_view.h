/* meshopt_view.h - decodes a bufferView of EXT_meshopt_compression or KHR_meshopt_compression. Implemented in
   meshopt_view.c and meshopt_decode.c. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_VIEW_H
#define FFD_MESH_MESHOPT_MESHOPT_VIEW_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>

typedef enum meshopt_mode { MESHOPT_ATTRIBUTES, MESHOPT_TRIANGLES, MESHOPT_INDICES } meshopt_mode;

typedef enum meshopt_filter {
    MESHOPT_NONE,
    MESHOPT_OCTAHEDRAL,
    MESHOPT_QUATERNION,
    MESHOPT_EXPONENTIAL,
    MESHOPT_COLOR
} meshopt_filter;

/* The most 4-byte numbers of an element. */
#define MESHOPT_COLUMNS 64

/* The most elements of a block of attributes. */
#define MESHOPT_BLOCK 256
/* Elements whose differences share a width; blocks are of whole groups. */
#define MESHOPT_GROUP 16

typedef struct meshopt_view {
    meshopt_mode mode;
    meshopt_filter filter;
    uint64_t count, stride;     /* number of elements, and bytes of an element; both below 2^54 */
    const unsigned char *bytes; /* borrowed */
    size_t size;
    /* For the filter EXPONENTIAL, whose numbers are integers times powers of two: receives the least exponent
       of each of the MESHOPT_COLUMNS numbers of an element, zeros ignored. May be NULL. */
    int8_t *exponents;
} meshopt_view;

/* Checks a view by its numbers and the first byte of its data. If it passes, count * stride is at most 1024
   times the size of the data. Errors, without a file name: FFD_E_INVALID, FFD_E_UNSUPPORTED (another
   version). */
ffd_status ffd_meshopt_check(const meshopt_view *view, ffd_error *error);

/* Returns the name of a mode. */
const char *ffd_meshopt_mode_name(meshopt_mode mode);

/* Returns the version of the codec that a view's data, of at least a byte, is of. */
unsigned ffd_meshopt_version(const meshopt_view *view);

/* Returns the size of what ends the data of a view that has at least a byte. */
uint64_t ffd_meshopt_tail(const meshopt_view *view);

/* Returns the number of elements of each block of attributes but the last. */
size_t ffd_meshopt_block(size_t stride);

/* Checks that what decodes a checked view is available. Errors, without a file name: FFD_E_UNSUPPORTED,
   FFD_E_MEMORY. */
ffd_status ffd_meshopt_ready(const meshopt_view *view, ffd_error *error);

/* Decodes a checked view, which is ready, into count * stride bytes with the alignment of ffd_alloc. Errors,
   without a file name: FFD_E_INVALID; the bytes are then undefined. */
ffd_status ffd_meshopt_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error);

#endif
