/* gltf_saver.h - the state of saving: the plan, the new buffers, the edits of the JSON. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_SAVER_H
#define FFD_IO_GLTF_WRITE_GLTF_SAVER_H

#include "io/gltf/write/gltf_plan.h"
#include "json/json_edit.h"

/* An accessor that is overwritten in place. */
typedef struct gltf_overwrite {
    size_t accessor;
    size_t begin, end, stride; /* in its buffer */
    size_t end_so_far;         /* the largest end of all overwrites in the list up to this one */
    const gltf_version *version;
} gltf_overwrite;

/* Compressed data that is written decompressed: a whole bufferView, or the elements of one accessor. */
typedef struct gltf_unpacking {
    size_t view, accessor;      /* exactly one of them is GLTF_NONE */
    bool indices;               /* whether the accessor's elements are indices */
    const unsigned char *bytes; /* the decompressed bytes before any change; those of the document, or own */
    unsigned char *own;         /* a copy of them in which something is mended; NULL: none */
    size_t size;
    size_t buffer, offset; /* where they go */
} gltf_unpacking;

/* The content of a new accessor, or decompressed data, after the old end of a buffer. */
typedef struct gltf_append {
    size_t offset, size, stride; /* size: of all elements; stride: a multiple of 4, as attributes require */
    size_t version;              /* GLTF_NONE: decompressed data */
    size_t unpacking;
    const unsigned char *sparse; /* the stored part of the version; NULL: all of it */
} gltf_append;

/* The nonzero elements of an appended version, if only these are stored: their indices, then their values. */
typedef struct gltf_stored_part {
    unsigned char *bytes; /* size, owned; NULL: all elements are stored */
    size_t size, values_at, count, index_size;
} gltf_stored_part;

typedef struct gltf_new_buffer {
    const gltf_buffer *old;     /* the document's buffer; an empty one if the buffer is new */
    size_t length;              /* its new byteLength */
    bool changed;               /* whether its bytes differ from the old ones */
    gltf_buffer_kind kind;      /* how the output stores it */
    gltf_overwrite *overwrites; /* sorted by begin */
    size_t overwrite_count;
    gltf_append *appends; /* sorted by offset */
    size_t append_count;
    char *target; /* the file to write; NULL: no file */
} gltf_new_buffer;

typedef struct gltf_saver {
    const gltf_document *document;
    const mesh_save_options *options;
    file_output *output; /* NULL: nothing is written, only checked whether it would be refused */
    const mesh_log *log;
    gltf_plan plan;
    gltf_unpacking *unpackings; /* those of single accessors come first */
    size_t unpacking_count, unpacked_accessor_count;
    gltf_stored_part *sparse; /* per version in plan.appended */
    /* Index in unpackings, per view and per accessor; GLTF_NONE: none. */
    size_t *view_unpackings, *accessor_unpackings;
    gltf_new_buffer *buffers; /* those of the document, then possibly a new one */
    size_t buffer_count;      /* one more than the document has if none of its buffers can grow */
    json_edits edits;
    byte_buffer left; /* uint32_t each: indices in extensions that cannot follow; may hold duplicates */
    bool binary;      /* whether the output is a GLB */
    bool in_place;    /* whether the output replaces the input */
} gltf_saver;

#endif
