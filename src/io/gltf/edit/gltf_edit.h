/* gltf_edit.h - what features change in a file and add to it, beside the results: accessors of the model,
   edits of its JSON, animation data. Each fills it once the results are complete; the writer (io/gltf/write)
   makes bytes of it. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_EDIT_H
#define FFD_IO_GLTF_EDIT_GLTF_EDIT_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

typedef struct gltf_edit {
    gltf_document *document; /* its model gets the further morph targets and their accessors */
    const mesh_log *log;
    bool any;                 /* whether anything is changed or added */
    json_edits edits;         /* of everything but meshes, which may be copied */
    byte_buffer bounded;      /* a byte for each accessor that the model has got: whether it states bounds */
    size_t accessor_capacity; /* room for accessors of the model; 0: it has its own ones only */
    byte_buffer accessors; /* the JSON of accessors of animation data, with commas; they follow the model's */
    size_t accessor_count; /* in accessors */
    byte_buffer bytes;     /* the animation data, in one new bufferView */
    gltf_values replaced;  /* animations that others replace */
    uint64_t bytes_left;   /* bytes that what is replaced leaves unused */
} gltf_edit;

/* Returns the number of the document's accessors, with those that are added. */
static inline size_t ffd_gltf_accessor_end(const gltf_document *document)
{
    return document->model.accessor_count + (document->edit ? document->edit->accessor_count : 0);
}

/* Returns the number of bytes of animation data that are added. */
static inline size_t ffd_gltf_added_bytes(const gltf_document *document)
{
    return document->edit ? document->edit->bytes.size : 0;
}

/* Returns the number of the document's bufferViews, with that of animation data. */
static inline size_t ffd_gltf_view_end(const gltf_document *document)
{
    return document->view_values.count + (ffd_gltf_added_bytes(document) > 0);
}

/* Returns the buffer that gets the animation data: the BIN chunk if the file has one, else a new buffer. */
size_t ffd_gltf_added_buffer(const gltf_document *document);

/* Adds an accessor of zeros, vectors of three floats, to the model. bounded: whether it states bounds.
   Returns its number; GLTF_NONE, with edits.failed set, if memory runs out. */
size_t ffd_gltf_add_zeros(gltf_edit *edit, uint64_t count, bool bounded);

/* Frees what the edit owns. What the model has got stays. */
void ffd_gltf_edit_free(gltf_edit *edit);

#endif
