/* gltf_draco.h - primitives of KHR_draco_mesh_compression, decoded into their accessors. */
#ifndef FFD_IO_GLTF_READ_GLTF_DRACO_H
#define FFD_IO_GLTF_READ_GLTF_DRACO_H

#include "io/gltf/read/gltf_document.h"

/* Decodes the compressed primitives of checked meshes; ffd_gltf_check calls it. A primitive whose data is not
   supported is left undecoded. Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_decode_draco(gltf_document *document, ffd_error *error);

/* Returns the JSON value of a primitive's Draco extension; JSON_NONE if the primitive is not compressed. */
uint32_t ffd_gltf_draco_value(const gltf_document *document, const gltf_primitive *primitive);

/* Fails with the reason why ffd_gltf_decode_draco left a primitive undecoded; returns FFD_OK if it did
   not. */
ffd_status ffd_gltf_refuse_draco(const gltf_document *document, const gltf_primitive *primitive,
                                 ffd_error *error);

#endif
