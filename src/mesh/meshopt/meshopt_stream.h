/* meshopt_stream.h - our own decoder of the streams of KHR_meshopt_compression (its appendix A), whose
   version 1 of attributes is newer than the meshoptimizer of many systems. Implemented in
   meshopt_attributes.c, meshopt_indices.c and meshopt_decode.c. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_STREAM_H
#define FFD_MESH_MESHOPT_MESHOPT_STREAM_H

#include "mesh/meshopt/meshopt_view.h"

/* The bytes that are still to be read. */
typedef struct meshopt_stream {
    const unsigned char *at, *end;
} meshopt_stream;

/* Takes the next bytes of a stream; NULL: it has fewer. */
static inline const unsigned char *meshopt_take(meshopt_stream *from, size_t size)
{
    if ((size_t)(from->end - from->at) < size)
        return NULL;
    from->at += size;
    return from->at - size;
}

/* Decodes a checked view of mode ATTRIBUTES, of version 0 or 1, without its filter into count * stride bytes.
   from: the bytes between the first one and the tail; what is left of them was not needed. Errors, without a
   file name: FFD_E_INVALID; the bytes are then undefined. */
ffd_status ffd_meshopt_read_attributes(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                       ffd_error *error);
/* The same of mode TRIANGLES, version 1. */
ffd_status ffd_meshopt_read_triangles(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                      ffd_error *error);
/* The same of mode INDICES, version 1. */
ffd_status ffd_meshopt_read_indices(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                                    ffd_error *error);

/* Decodes any of these views without its filter. Errors: the same. */
ffd_status ffd_meshopt_read(const meshopt_view *view, unsigned char *bytes, ffd_error *error);

#endif
