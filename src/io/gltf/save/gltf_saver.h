/* gltf_saver.h - what belongs to one saving: the plan, the new buffers, the edits of the JSON. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_SAVER_H
#define FFD_IO_GLTF_SAVE_GLTF_SAVER_H

#include "io/gltf/save/gltf_plan.h"
#include "json/json_edit.h"

/* An accessor whose content changes where it stands. */
typedef struct gltf_overwrite {
    size_t accessor;
    size_t begin, end, stride; /* in its buffer */
    size_t end_so_far;         /* the largest end up to this one in the list */
    const float *values;
} gltf_overwrite;

/* Compressed data that the output holds decoded: a whole bufferView, or the elements of one accessor. */
typedef struct gltf_unpacking {
    size_t view, accessor;      /* the other one is GLTF_NONE */
    bool indices;               /* the accessor's elements are indices */
    const unsigned char *bytes; /* before any change; lent by the document */
    size_t size;
    size_t buffer, offset; /* where it goes */
} gltf_unpacking;

/* A new accessor's content, or what was compressed, behind the old end of its buffer. */
typedef struct gltf_append {
    size_t offset, size, stride; /* size: all of it; stride: a multiple of 4, as attributes need */
    size_t version;              /* GLTF_NONE: unpacked data */
    size_t unpacking;
} gltf_append;

typedef struct gltf_new_buffer {
    const gltf_buffer *old;     /* lent; of kind BUFFER_EMPTY and of no length for one that is added */
    size_t length;              /* its new byteLength */
    bool changed;               /* its bytes are not those of before */
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
    file_output *output;
    const mesh_log *log;
    gltf_plan plan;
    gltf_unpacking *unpackings; /* those of accessors come first */
    size_t unpacking_count, unpacked_accessor_count;
    size_t *view_unpackings, *accessor_unpackings; /* numbers in them, GLTF_NONE */
    gltf_new_buffer *buffers;                      /* those of the document, then an added one */
    size_t buffer_count; /* one more than the document has where none of those takes bytes */
    json_edits edits;
    bool binary;   /* the output is a GLB */
    bool in_place; /* the output is the input */
    bool replaces; /* some buffer file that exists is replaced */
} gltf_saver;

/* gltf_announce.c: tells what was left alone, copied or stored otherwise; comes after all else is known. */
void ffd_gltf_announce(const gltf_saver *saver);

/* gltf_unpack.c: what is to be decoded, from the plan. */
ffd_status ffd_gltf_list_unpackings(gltf_saver *saver, ffd_error *error);
void ffd_gltf_free_unpackings(gltf_saver *saver);
/* Whether primitive p of a mesh, as it is shown at a place (of its showing), leaves its compression. */
bool ffd_gltf_is_unpacked(const gltf_saver *saver, size_t mesh, size_t p, size_t place);
/* Takes the compression out of the primitives of a mesh, as it is shown at a place, and tells of it. */
void ffd_gltf_edit_compression(const gltf_saver *saver, size_t mesh, size_t place, json_edits *edits);
/* Lets the views and accessors name the decoded data. */
void ffd_gltf_edit_unpackings(gltf_saver *saver);
/* Appends the bufferViews of unpacked accessors to those of appended ones. */
void ffd_gltf_write_unpacked_views(const gltf_saver *saver, byte_buffer *text);
/* Whether something left this compression and nothing in the output has it. */
bool ffd_gltf_lost_draco(gltf_saver *saver);
bool ffd_gltf_lost_ext_meshopt(gltf_saver *saver);
bool ffd_gltf_lost_khr_meshopt(gltf_saver *saver);

/* gltf_content.c: fills overwrites, appends and lengths of saver->buffers from the plan. */
ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error);
/* The buffer that an accessor's copy is appended to. */
size_t ffd_gltf_append_buffer(const gltf_document *document, size_t accessor);
void ffd_gltf_free_content(gltf_saver *saver);
/* Bytes of the new content of a buffer: more than its length where the old one had more and did not grow. */
size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer);
/* Its bytes [offset, offset + size). */
void ffd_gltf_content_read(const gltf_saver *saver, size_t buffer, size_t offset, size_t size,
                           unsigned char *bytes);
/* How many bytes from offset on stand in memory as they are to be written, of the old content or among
   results, which *bytes then points to. 0: they must be read. */
size_t ffd_gltf_content_at(const gltf_saver *saver, size_t buffer, size_t offset,
                           const unsigned char **bytes);

/* gltf_content_write.c: writes it, in base64 or as it is. */
ffd_status ffd_gltf_write_content(const gltf_saver *saver, size_t buffer, bool base64, ffd_error *error);

/* gltf_container.c: how the output holds each buffer. A .gltf that becomes a GLB has its first buffer in the
   BIN chunk and the other files as data URIs, so that it is one file; a GLB that becomes a .gltf has its BIN
   chunk in a file beside it, on standard output in a data URI. */
void ffd_gltf_place_buffers(gltf_saver *saver);
/* The edits of the JSON for the buffers that are held otherwise than before, but for files' names. */
void ffd_gltf_move_buffers(gltf_saver *saver);
/* Inserts a member before the end of a buffer's object. */
void ffd_gltf_add_uri(gltf_saver *saver, size_t buffer, const char *uri);
/* gltf_patch.c: the edits of the JSON that the plan and the new buffers need. */
ffd_status ffd_gltf_make_edits(gltf_saver *saver, ffd_error *error);
/* gltf_bounds.c: "min" and "max" of an accessor that gets a version, where it has them. */
void ffd_gltf_edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits);
/* Likewise of one that keeps its content. */
void ffd_gltf_edit_original_bounds(const gltf_saver *saver, size_t accessor, json_edits *edits);
/* gltf_lists.c: adds elements (their text, with commas between them) to a list at the top of the JSON, which
   is made where it is missing; more than once only if it is not empty before. */
void ffd_gltf_add_elements(gltf_saver *saver, const gltf_values *list, const char *key,
                           const byte_buffer *text);
/* The added buffer, where there is one. */
void ffd_gltf_add_buffer(gltf_saver *saver);
/* gltf_extensions.c: takes extensions that the output no longer needs out of the lists of those used and
   required. */
void ffd_gltf_drop_extensions(gltf_saver *saver);
/* gltf_targets.c: names for the buffers' files, and their URIs. */
ffd_status ffd_gltf_name_buffers(gltf_saver *saver, ffd_error *error);
/* gltf_resources.c: images beside the output, or their URIs. Refuses an image that has the name of a file of
   the model itself. Begins and writes files of saver->output; comes after ffd_gltf_name_buffers. */
ffd_status ffd_gltf_bring_images(gltf_saver *saver, ffd_error *error);

#endif
