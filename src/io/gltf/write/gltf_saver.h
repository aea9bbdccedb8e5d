/* gltf_saver.h - the state of saving: the plan, the new buffers, the edits of the JSON; and the steps, in the
   order of gltf_save.c: gltf_content.c (with gltf_unpack.c, gltf_mend_weights.c, gltf_targets.c),
   gltf_container.c, gltf_patch.c (with gltf_targets.c, gltf_bounds.c, gltf_follow.c, gltf_extensions.c),
   gltf_resources.c, gltf_announce.c. */
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

/* The content of a new accessor, or other data, after the old end of a buffer. */
typedef struct gltf_append {
    size_t offset, size, stride; /* size: of all elements; stride: a multiple of 4, as attributes require */
    size_t version;              /* GLTF_NONE: none */
    /* Decompressed data, that of an edit, the stored part of a version; NULL: all elements of the version. */
    const unsigned char *bytes;
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

/* Lists saver->unpackings from the plan. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_list_unpackings(gltf_saver *saver, ffd_error *error);

/* Frees saver's lists of unpackings. */
void ffd_gltf_free_unpackings(gltf_saver *saver);

/* Whether primitive p is written decompressed for a use of its mesh. */
bool ffd_gltf_is_unpacked(const gltf_saver *saver, const gltf_primitive *primitive, size_t use);

/* Removes, and logs, the compression of the primitives that are written decompressed for a use of their
   mesh. */
void ffd_gltf_edit_compression(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits views and accessors to name the decompressed data. */
void ffd_gltf_edit_unpackings(gltf_saver *saver);

/* Appends the bufferViews of decompressed accessors to the text of a list. */
void ffd_gltf_write_unpacked_views(const gltf_saver *saver, byte_buffer *text);

/* Whether primitives were decompressed and no primitive of the output is compressed by Draco. */
bool ffd_gltf_lost_draco(gltf_saver *saver);

/* Whether views were decompressed and nothing in the output uses EXT_meshopt_compression. */
bool ffd_gltf_lost_ext_meshopt(gltf_saver *saver);

/* Whether views were decompressed and nothing in the output uses KHR_meshopt_compression. */
bool ffd_gltf_lost_khr_meshopt(gltf_saver *saver);

/* Makes weights that are written decompressed valid (glTF 2.0, 3.7.3.3), since compression has rounded them
   and validators do not look into compressed data: those of a vertex sum to 1 in the numbers of the file, no
   joint has two of them, and the joint of a weight of 0 is 0. Vertices where all of this holds keep their
   bytes. Replaces the bytes of unpackings by copies. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_mend_weights(gltf_saver *saver, ffd_error *error);

/* Makes saver->sparse: for each appended version of an accessor that the program added, the nonzero vectors,
   if the document allows it and at least two thirds of the vectors are 0. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_list_sparse(gltf_saver *saver, ffd_error *error);

/* Frees saver->sparse. */
void ffd_gltf_free_sparse(gltf_saver *saver);

/* Makes saver->buffers from the plan, with their overwrites, appends and lengths. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error);

/* Frees saver->buffers. */
void ffd_gltf_free_content(gltf_saver *saver);

/* Returns the buffer to which the copy of an accessor is appended. */
size_t ffd_gltf_append_buffer(const gltf_document *document, size_t accessor);

/* Returns the number of bytes of a buffer's new content. It exceeds the buffer's length if the old content
   did and has not grown. */
size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer);

/* Writes a buffer's new content to the output, as base64 or unchanged. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_write_content(const gltf_saver *saver, size_t buffer, bool base64, ffd_error *error);

/* Chooses the kind of each new buffer. If a .gltf becomes a GLB, its first buffer goes into the BIN chunk and
   the other files become data URIs, so that the result is one file. If a GLB becomes a .gltf, its BIN chunk
   goes into a file beside it; on standard output, into a data URI. */
void ffd_gltf_choose_buffer_kinds(gltf_saver *saver);

/* Edits the JSON of buffers whose kind changed, except the names of files. */
void ffd_gltf_move_buffers(gltf_saver *saver);

/* Chooses the names and edits the buffers' URIs. Errors: FFD_E_EXISTS, FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_gltf_name_buffers(gltf_saver *saver, ffd_error *error);

/* Writes the bounds of an accessor that saving adds, as members after others. version: its content; NULL:
   zeros. */
void ffd_gltf_write_bounds(const gltf_saver *saver, const gltf_version *version, byte_buffer *text);

/* Edits the bounds of the accessor that a version overwrites, if it has bounds. */
void ffd_gltf_edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits);

/* Edits the bounds of an accessor that is written decompressed, and does not change else. */
void ffd_gltf_edit_unpacked_bounds(const gltf_saver *saver, const gltf_unpacking *unpacking,
                                   json_edits *edits);

/* Edits the morph targets of a mesh for a use: they name the accessors with its content, and the further ones
   are added, with weights and names. */
void ffd_gltf_edit_targets(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Adds weights of 0 for further morph targets to the nodes that have weights of their own. */
void ffd_gltf_edit_node_weights(gltf_saver *saver);

/* Whether a morph target of a mesh is written anew: it replaces the file's, or is a further one. */
bool ffd_gltf_replaces_target(const gltf_document *document, size_t mesh, size_t target);

/* Adds the accessors that the document's edit adds: those of further morph targets, then those of animations.
 */
void ffd_gltf_add_new_accessors(gltf_saver *saver);
/* Appends one of them to the text of a list, with the content of version plan.appended[appended]; GLTF_NONE:
   zeros. */
void ffd_gltf_write_new_accessor(const gltf_saver *saver, size_t accessor, size_t appended,
                                 byte_buffer *text);

/* Makes and logs these edits. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_make_edits(gltf_saver *saver, ffd_error *error);

/* Edits the extensions of a mesh: they name the accessors that hold the mesh's content for this use. */
void ffd_gltf_follow_accessors(gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits references to copied meshes: a node that shows a copy refers to the copy, and elements of per-mesh
   lists are repeated for the copies. Warns of references that cannot follow, those to accessors included, so
   call it last. Errors: FFD_E_LIMIT (the repeated elements exceed the memory budget), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_meshes(gltf_saver *saver, ffd_error *error);

/* Removes them from extensionsUsed and extensionsRequired. */
void ffd_gltf_drop_extensions(gltf_saver *saver);

/* Warns of arrays, objects and numbers in extensions and extras whose names tell that they are bounds
   (`sceneBounds`, `boundingSphere`, `bbox_min`), where what they are of is deformed or moves: they stay as
   they are. If memory runs out, saver->edits fail. */
void ffd_gltf_warn_of_stale(gltf_saver *saver);

/* Copies the images beside the output, or edits their URIs. A file that is not an image, is hidden, or is
   reached through a link is not copied, with a warning. Refuses an image with the name of a file of the model
   itself. Begins and writes files of saver->output; call it after ffd_gltf_name_buffers. Errors:
   FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_bring_images(gltf_saver *saver, ffd_error *error);

/* Warns of JSON values with their count, each once, and names the first three. values: uint32_t each, which
   are sorted. Returns the count. If memory runs out, saver->edits fail. */
size_t ffd_gltf_warn_of_values(gltf_saver *saver, byte_buffer *values, const char *one, const char *many);

/* Logs what was left unchanged, copied or stored in another way. Call it after all edits. */
void ffd_gltf_announce(const gltf_saver *saver);

#endif
