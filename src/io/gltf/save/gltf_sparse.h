/* gltf_sparse.h - offsets of morph targets that are 0 for the most part: only the others are stored. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_SPARSE_H
#define FFD_IO_GLTF_SAVE_GLTF_SPARSE_H

#include "io/gltf/save/gltf_saver.h"

/* Makes saver->sparse: what is stored of appended versions of accessors that we added, where a document
   allows it and two thirds of the vectors are 0. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_list_sparse(gltf_saver *saver, ffd_error *error);

/* The member "sparse" of an accessor, with a comma after it. view: of its indices and values. */
void ffd_gltf_write_sparse(const gltf_stored_part *sparse, size_t view, byte_buffer *text);

/* Frees saver->sparse. */
void ffd_gltf_free_sparse(gltf_saver *saver);

#endif
