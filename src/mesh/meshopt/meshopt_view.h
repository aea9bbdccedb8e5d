/* meshopt_view.h - decodes a bufferView of EXT_meshopt_compression, by the meshoptimizer library. Declares
   meshopt_decode.c and meshopt_load.c too, of which a program has one. */
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
    MESHOPT_EXPONENTIAL
} meshopt_filter;

/* Numbers of 4 bytes that an element may have. */
#define MESHOPT_COLUMNS 64

typedef struct meshopt_view {
    meshopt_mode mode;
    meshopt_filter filter;
    uint64_t count, stride;     /* elements, bytes of each; below 2^54 each */
    const unsigned char *bytes; /* lent */
    size_t size;
    /* With the filter EXPONENTIAL, whose numbers are whole multiples of powers of two: gets the least
       exponent of each of an element's numbers, zeros not counted (MESHOPT_COLUMNS); or NULL. */
    int8_t *exponents;
} meshopt_view;

/* Refuses what cannot be valid, from the data's first byte and the numbers alone; afterwards count *
   stride is at most 64 times the size. Errors, without a file's name: FFD_E_INVALID, FFD_E_UNSUPPORTED
   (another version). */
ffd_status ffd_meshopt_check(const meshopt_view *view, ffd_error *error);

/* The name of a mode. */
const char *ffd_meshopt_mode_name(meshopt_mode mode);

/* Whether the library is there. Errors, without a file's name: FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_meshopt_ready(ffd_error *error);

/* Decodes a view that was checked, when the library is there, into count * stride bytes, aligned as by
   ffd_alloc. Errors: FFD_E_INVALID; the bytes are then undefined. */
ffd_status ffd_meshopt_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error);

#endif
