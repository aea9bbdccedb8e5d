/* gltf_buffer.h - the buffers of a glTF file: the GLB's own, data URIs, files beside the model. */
#ifndef FFD_IO_GLTF_FILE_GLTF_BUFFER_H
#define FFD_IO_GLTF_FILE_GLTF_BUFFER_H

#include "base/file/input.h"
#include "json/json_span.h"

typedef enum gltf_buffer_kind {
    BUFFER_EMPTY, /* no bytes in this file: a placeholder for compressed data */
    BUFFER_BIN,   /* the BIN chunk */
    BUFFER_DATA,  /* a data URI */
    BUFFER_FILE
} gltf_buffer_kind;

typedef struct gltf_buffer {
    gltf_buffer_kind kind;
    const unsigned char *data; /* NULL where empty */
    size_t length;             /* byteLength */
    size_t size;               /* bytes there are, length or more */
    unsigned char *decoded;    /* owned, of a data URI */
    file_input file;           /* owned, of a file */
    char *path;                /* owned, of a file: relative to the model's folder, decoded */
} gltf_buffer;

/* Reads buffer `value` of the JSON. bin is the BIN chunk for the first buffer of a GLB, else NULL.
   model is the path of the model, "-" for standard input, which has no folder; messages call the file
   name. On failure *buffer is empty. Errors: FFD_E_INVALID, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_buffer(const json_span *tree, uint32_t value, const unsigned char *bin,
                                size_t bin_size, const char *model, const char *name, gltf_buffer *buffer,
                                ffd_error *error);

/* Frees what the buffer owns and empties it. */
void ffd_gltf_free_buffer(gltf_buffer *buffer);

/* Returns the offset of the data in a data URI of size characters, past its comma; SIZE_MAX if there is
   no comma. Sets *base64 if the data is in base64. */
size_t ffd_data_uri_payload(const char *uri, size_t size, bool *base64);

#endif
