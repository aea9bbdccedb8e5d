/* gltf_refuse.h - refuses valid files that need something unsupported. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_REFUSE_H
#define FFD_IO_GLTF_MODEL_GLTF_REFUSE_H

#include "io/gltf/read/gltf_document.h"

/* Refuses what would make positions wrong or unreadable. Errors: FFD_E_UNSUPPORTED, FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_refuse_read(const gltf_document *document, ffd_error *error);

/* Refuses attributes that cannot be written back: positions, and normals and tangents if wanted. Errors:
   FFD_E_UNSUPPORTED. */
ffd_status ffd_gltf_refuse_store(const gltf_document *document, bool normals, bool tangents,
                                 ffd_error *error);

/* Refuses a primitive if this accessor cannot be read. Errors: FFD_E_UNSUPPORTED. */
ffd_status ffd_gltf_refuse_unreadable(const gltf_document *document, size_t mesh, size_t primitive,
                                      int accessor, ffd_error *error);

#endif
