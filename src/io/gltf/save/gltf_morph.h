/* gltf_morph.h - a further morph target for meshes: first of zeros, in the text of the file; its offsets then
   go the way of all results. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_MORPH_H
#define FFD_IO_GLTF_SAVE_GLTF_MORPH_H

#include "io/gltf/save/gltf_saver.h"

/* Bytes that new animation data takes behind the file's own. */
typedef struct morph_data {
    byte_buffer accessors; /* texts of new accessors, with commas */
    size_t accessor_count; /* of them */
    byte_buffer bytes;     /* of one new bufferView */
} morph_data;

/* gltf_morph_text.c: the file with a further target, for each mesh that is marked, of zeros for the deformed
   attributes of its primitives; its name, its weight 0 and the animations of weights are there. The target of
   a primitive is its last one. *made is the caller's. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const bool *meshes, const mesh_log *log,
                               file_input *made, ffd_error *error);

/* gltf_morph_weights.c: lets animations of the weights of these meshes' nodes have a 0 for the target. */
void ffd_gltf_extend_weights(gltf_saver *saver, const bool *meshes, morph_data *data);

/* gltf_as_morph.c: saves a document whose results are offsets. */
ffd_status ffd_gltf_save_as_morph(mesh_document *document, const mesh_save_options *options,
                                  file_output *output, const mesh_log *log, ffd_error *error);

/* Inserts a text behind the last member of a container of the JSON, with a comma where it is needed. Once a
   container. */
void ffd_gltf_insert_last(gltf_saver *saver, uint32_t container, const byte_buffer *text);
/* The targets of a mesh. */
size_t ffd_gltf_target_count(const gltf_document *document, size_t mesh);

#endif
