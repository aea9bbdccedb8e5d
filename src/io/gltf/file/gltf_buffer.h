/* gltf_buffer.h - the buffers of a glTF file: the GLB's own, data URIs, files beside the model. */
#ifndef FFD_IO_GLTF_FILE_GLTF_BUFFER_H
#define FFD_IO_GLTF_FILE_GLTF_BUFFER_H

#include "base/file/file_folder.h"
#include "json/json_tree.h"
#include <stddef.h>

typedef enum gltf_buffer_kind {
    BUFFER_EMPTY, /* no bytes in this file: a placeholder for compressed data */
    BUFFER_BIN,   /* the BIN chunk */
    BUFFER_DATA,  /* a data URI */
    BUFFER_FILE
} gltf_buffer_kind;

/* Flaws of a buffer whose meaning is still clear, joined by |. */
enum {
    BUFFER_ODD_MARKER = 1, /* ";base64" of a data URI in upper case, with blanks, or not last */
    BUFFER_BLANKS = 2,     /* blanks among the digits of base64 */
    BUFFER_BACKSLASH = 4,  /* a backslash for a slash in the name of its file */
    BUFFER_SHORT = 8,      /* fewer bytes than byteLength says */
    BUFFER_LONG = 16       /* more bytes than byteLength says and than padding takes */
};

typedef struct gltf_buffer {
    gltf_buffer_kind kind;
    const unsigned char *data; /* NULL if empty */
    size_t stated;             /* byteLength */
    size_t length;             /* byteLength, or the number of bytes if that is smaller */
    size_t size;               /* number of bytes, length or more */
    unsigned flaws;            /* BUFFER_ODD_MARKER and so on */
    unsigned char *decoded;    /* owned, from a data URI */
    file_input file;           /* owned, an external file */
    char *path;                /* owned, of the external file: relative to the model's folder, decoded */
} gltf_buffer;

/* Reads buffer `value` of the JSON. bin is the BIN chunk for the first buffer of a GLB, else NULL. model is
   the path of the model, or "-" for standard input, which has no folder; name stands for the file in
   messages. most_read: as in ffd_file_load_within. After a failure *buffer is empty. Errors: FFD_E_INVALID,
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_buffer(const json_tree *tree, uint32_t value, const unsigned char *bin,
                                size_t bin_size, const file_folder *model, const char *name,
                                size_t *most_read, gltf_buffer *buffer, ffd_error *error);

/* Decodes a data URI, the JSON string `uri`, into *buffer, which is empty after a failure. Errors:
   FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_data_uri(const json_tree *tree, uint32_t uri, const char *name, gltf_buffer *buffer,
                                  ffd_error *error);

/* Frees what the buffer owns, and empties it. */
void ffd_gltf_free_buffer(gltf_buffer *buffer);

typedef enum data_uri_coding { DATA_PLAIN, DATA_BASE64, DATA_BASE64_ODD } data_uri_coding;

/* Returns the offset of the data in a data URI of size characters: past its comma, or SIZE_MAX without one. A
   parameter "base64" before the comma means base64 (RFC 2397); its case does not matter, and blanks may
   surround it and other parameters follow it. *coding is DATA_BASE64_ODD if it is not exactly ";base64" at
   the end. */
size_t ffd_data_uri_payload(const char *uri, size_t size, data_uri_coding *coding);

/* Counts the buffers of a JSON text that have a URI other than a data URI. Allocates nothing. The result for
   invalid JSON is arbitrary. */
size_t ffd_gltf_count_buffer_files(const char *text, size_t size);

#endif
