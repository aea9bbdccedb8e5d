/* gltf_edit.h - what features change in a file and add to it, beside the results: accessors of the model, new
   elements of others, edits of its JSON, animation data, nodes that follow. The rig fills it before vertices
   are written, all others once the results are complete; the writer (io/gltf/write) makes bytes of it. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_EDIT_H
#define FFD_IO_GLTF_EDIT_GLTF_EDIT_H

#include "base/memory/intern.h"
#include "io/gltf/edit/gltf_rig.h"
#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

/* New elements of an accessor. */
typedef struct gltf_content {
    size_t accessor;     /* GLTF_NONE: a new accessor of MAT4 */
    size_t count, width; /* number of elements; numbers per element */
    float *values;       /* from the document's memory budget */
} gltf_content;

typedef struct gltf_edit {
    gltf_document *document; /* its model gets the further morph targets and their accessors */
    const mesh_log *log;
    bool any;                 /* whether anything is changed or added */
    json_edits edits;         /* of everything but meshes, which may be copied, and the rig */
    byte_buffer bounded;      /* a byte for each accessor that the model has got: whether it states bounds */
    size_t accessor_capacity; /* room for accessors of the model; 0: it has its own ones only */
    byte_buffer accessors; /* the JSON of accessors of animation data, with commas; they follow the model's */
    size_t accessor_count; /* in accessors */
    byte_buffer bytes;     /* the animation data, in one new bufferView */
    uint64_t bytes_left;   /* bytes that what is replaced leaves unused */
    gltf_content *contents; /* all different */
    size_t content_count, content_capacity;
    intern_table known; /* to find equal contents */
    gltf_rig rig;
} gltf_edit;

/* Whether the nodes of a document follow the deformation. */
static inline bool ffd_gltf_follows(const gltf_document *document)
{
    return document->edit->rig.world;
}

/* Returns the number of the document's accessors, with those that are added. */
static inline size_t ffd_gltf_accessor_end(const gltf_document *document)
{
    return document->model.accessor_count + document->edit->accessor_count;
}

/* Returns the number of the document's bufferViews, with that of animation data. */
static inline size_t ffd_gltf_view_end(const gltf_document *document)
{
    return document->view_values.count + (document->edit->bytes.size > 0);
}

/* Returns the buffer that gets the animation data: the BIN chunk if the file has one, else a new buffer. */
size_t ffd_gltf_added_buffer(const gltf_document *document);

/* Adds an accessor of zeros, vectors of three floats, to the model. bounded: whether it states bounds.
   Returns its index; GLTF_NONE, with edits.failed set, if memory runs out. */
size_t ffd_gltf_add_zeros(gltf_edit *edit, uint64_t count, bool bounded);

/* Allocates content->values, from the memory budget. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_elements(gltf_edit *edit, gltf_content *content, ffd_error *error);
/* Frees content->values, for content that is not added. */
void ffd_gltf_free_elements(gltf_edit *edit, gltf_content *content);
/* Adds content, unless the edit has equal content. Takes ownership of the values, even if it fails. Returns
   the index in edit->contents; GLTF_NONE if memory runs out. */
size_t ffd_gltf_add_content(gltf_edit *edit, gltf_content *content);

/* Makes the document's edit, which is empty. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_make_edit(gltf_document *document, ffd_error *error);
/* Empties it. What the model has got stays; nothing follows the deformation, and no part is carried. */
void ffd_gltf_clear_edit(gltf_document *document);
/* Clears and frees it, if it was made. */
void ffd_gltf_free_edit(gltf_document *document);

#endif
