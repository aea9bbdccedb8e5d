/* glb.h - the container of a .glb file (glTF 2.0, 4.4). */
#ifndef FFD_IO_GLTF_FILE_GLB_H
#define FFD_IO_GLTF_FILE_GLB_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLB_HEADER_SIZE 12
#define GLB_CHUNK_HEADER_SIZE 8
#define GLB_MAGIC 0x46546c67u
#define GLB_VERSION 2
#define GLB_CHUNK_JSON 0x4e4f534au
#define GLB_CHUNK_BIN 0x004e4942u

/* Returns size rounded up to a multiple of 4, the alignment of chunks, matrix columns and vertex attributes
   (glTF 2.0, 3.6.2.4 and 4.4.3.1). */
static inline uint64_t ffd_gltf_align(uint64_t size)
{
    return (size + 3) / 4 * 4;
}

/* Offsets of the chunks' content in the file; sizes are those that the chunk headers state, without the
   headers themselves. */
typedef struct glb_layout {
    size_t json_begin, json_size;
    bool has_bin; /* the second chunk is BIN */
    size_t bin_begin, bin_size;
    size_t rest_begin, end; /* further chunks, up to the length that the file's header states */
    size_t uneven;          /* where the first chunk begins whose size is not a multiple of 4; 0: none */
    size_t more_bins;       /* BIN chunks that nothing reads: only the second chunk may be one */
} glb_layout;

/* Whether the data starts with the magic number of a GLB. */
bool ffd_glb_is(const unsigned char *data, size_t size);

/* Reads the header and the chunk headers. Bytes past the stated length are allowed. Errors:
   FFD_E_INVALID, FFD_E_UNSUPPORTED (another version). */
ffd_status ffd_glb_parse(const unsigned char *data, size_t size, const char *name, glb_layout *layout,
                         ffd_error *error);

#endif
