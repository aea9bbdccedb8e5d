/* gltf_morph_weights.h - animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_MORPH_WEIGHTS_H
#define FFD_IO_GLTF_SAVE_GLTF_MORPH_WEIGHTS_H

#include "io/gltf/save/gltf_saver.h"

/* What a further morph target adds to the file. */
typedef struct morph_data {
    byte_buffer accessors; /* texts of new accessors, with commas */
    size_t accessor_count; /* of them */
    byte_buffer bytes;     /* of one new bufferView, for new animation data */
} morph_data;

/* Returns the number of morph targets of a mesh: the largest that a primitive of it has. */
size_t ffd_gltf_target_count(const gltf_document *document, size_t mesh);

/* Gives animations of the weights of these meshes' nodes a weight 0 for the further target. */
void ffd_gltf_extend_weights(gltf_saver *saver, const bool *meshes, morph_data *data);

#endif
