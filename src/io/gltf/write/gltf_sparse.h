/* gltf_sparse.h - stores only the nonzero offsets of morph targets that are mostly 0. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_SPARSE_H
#define FFD_IO_GLTF_WRITE_GLTF_SPARSE_H

#include "io/gltf/write/gltf_saver.h"

/* Makes saver->sparse: for each appended version of an accessor that the program added, the nonzero vectors,
   if the document allows it and at least two thirds of the vectors are 0. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_list_sparse(gltf_saver *saver, ffd_error *error);

/* Writes the member "sparse" of an accessor, followed by a comma. view: the bufferView of its indices and
   values. */
void ffd_gltf_write_sparse(const gltf_stored_part *sparse, size_t view, byte_buffer *text);

/* Frees saver->sparse. */
void ffd_gltf_free_sparse(gltf_saver *saver);

#endif
