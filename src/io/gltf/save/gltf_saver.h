/* gltf_saver.h - what belongs to one saving: the plan, the new buffers, the edits of the JSON. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_SAVER_H
#define FFD_IO_GLTF_SAVE_GLTF_SAVER_H

#include "io/gltf/save/gltf_plan.h"
#include "json/json_edit.h"

/* An accessor that is overwritten in place. */
typedef struct gltf_overwrite {
    size_t accessor;
    size_t begin, end, stride; /* in its buffer */
    size_t end_so_far;         /* the largest end up to this one in the list */
    const gltf_version *version;
} gltf_overwrite;

/* Compressed data that is written decoded: a whole bufferView, or the elements of one accessor. */
typedef struct gltf_unpacking {
    size_t view, accessor;      /* the other one is GLTF_NONE */
    bool indices;               /* the accessor's elements are indices */
    const unsigned char *bytes; /* before any change; owned by the document */
    size_t size;
    size_t buffer, offset; /* where it goes */
} gltf_unpacking;

/* A new accessor's content, or decoded data, past the old end of a buffer. */
typedef struct gltf_append {
    size_t offset, size, stride; /* size: all of it; stride: a multiple of 4, as attributes need */
    size_t version;              /* GLTF_NONE: unpacked data */
    size_t unpacking;
    const unsigned char *sparse; /* what is stored of the version; NULL: all of it */
} gltf_append;

/* The elements of an appended version that are not 0, where the others are not stored: their numbers, then
 * values. */
typedef struct gltf_stored_part {
    unsigned char *bytes; /* size, owned; NULL: all elements are stored */
    size_t size, values_at, count, index_size;
} gltf_stored_part;

typedef struct gltf_new_buffer {
    const gltf_buffer *old;     /* the document's; an empty one if the buffer is added */
    size_t length;              /* its new byteLength */
    bool changed;               /* its bytes differ from the old ones */
    gltf_buffer_kind kind;      /* how the output holds it */
    gltf_overwrite *overwrites; /* by begin */
    size_t overwrite_count;
    gltf_append *appends; /* by offset */
    size_t append_count;
    char *target; /* the file to write; NULL: none */
} gltf_new_buffer;

typedef struct gltf_saver {
    const gltf_document *document;
    const mesh_save_options *options;
    file_output *output; /* NULL: nothing is written, but what would be refused is */
    const mesh_log *log;
    gltf_plan plan;
    gltf_unpacking *unpackings; /* those of accessors come first */
    size_t unpacking_count, unpacked_accessor_count;
    gltf_stored_part *sparse;                      /* of each version in plan.appended */
    size_t *view_unpackings, *accessor_unpackings; /* numbers in it; GLTF_NONE: none */
    gltf_new_buffer *buffers;                      /* those of the document, then possibly an added one */
    size_t buffer_count; /* one more than the document has if none of those can grow */
    json_edits edits;
    byte_buffer left; /* uint32_t each, perhaps twice: indices in extensions that cannot follow */
    bool binary;      /* the output is a GLB */
    bool in_place;    /* the output is the input */
} gltf_saver;

#endif
