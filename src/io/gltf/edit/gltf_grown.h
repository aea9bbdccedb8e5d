/* gltf_grown.h - a file with further accessors, made in memory: the edited JSON, and the old bytes followed
   by new ones. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_GROWN_H
#define FFD_IO_GLTF_EDIT_GLTF_GROWN_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

/* The edits of the file's JSON, and the additions to it. */
typedef struct gltf_grown {
    const gltf_document *document;
    const mesh_log *log;
    json_edits edits;
    byte_buffer accessors; /* the JSON of new accessors, with commas */
    size_t accessor_count; /* in accessors */
    byte_buffer bytes;     /* new animation data, in one new bufferView */
} gltf_grown;

/* Makes the file; call it after all edits. The caller owns *made. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_grown_write(gltf_grown *grown, file_input *made, ffd_error *error);
/* Frees the edits and additions. */
void ffd_gltf_grown_free(gltf_grown *grown);

#endif
