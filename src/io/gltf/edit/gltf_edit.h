/* gltf_edit.h - what features change in a file and add to it, beside the results: edits of its JSON,
   accessors, bytes. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_EDIT_H
#define FFD_IO_GLTF_EDIT_GLTF_EDIT_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

typedef struct gltf_edit {
    const gltf_document *document;
    const mesh_log *log;
    json_edits edits;
    byte_buffer accessors; /* the JSON of new accessors, with commas */
    size_t accessor_count; /* in accessors */
    byte_buffer bytes;     /* new animation data, in one new bufferView */
    gltf_values replaced;  /* animations that others replace */
} gltf_edit;

/* Returns the number of the document's accessors, with those that are added. */
static inline size_t ffd_gltf_accessor_end(const gltf_document *document)
{
    return document->model.accessor_count + (document->edit ? document->edit->accessor_count : 0);
}

/* Returns the number of bytes that are added. */
static inline size_t ffd_gltf_added_bytes(const gltf_document *document)
{
    return document->edit ? document->edit->bytes.size : 0;
}

/* The same of bufferViews. */
static inline size_t ffd_gltf_view_end(const gltf_document *document)
{
    return document->view_values.count + (ffd_gltf_added_bytes(document) > 0);
}

/* Returns the buffer that gets the added bytes: the BIN chunk if the file has one, else a new buffer. */
size_t ffd_gltf_added_buffer(const gltf_document *document);

/* Makes a file in memory of the old one and the edit. The caller owns *made. Errors: FFD_E_MEMORY,
   FFD_E_LIMIT. */
ffd_status ffd_gltf_edit_write(gltf_edit *edit, file_input *made, ffd_error *error);
/* Frees what the edit owns; saving has taken its edits of the JSON. */
void ffd_gltf_edit_free(gltf_edit *edit);

#endif
