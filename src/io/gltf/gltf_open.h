/* gltf_open.h - opens and closes a glTF document. */
#ifndef FFD_IO_GLTF_GLTF_OPEN_H
#define FFD_IO_GLTF_GLTF_OPEN_H

#include "io/gltf/read/gltf_document.h"

/* Opens like ffd_gltf_open, but with a memory budget that other documents share. */
ffd_status ffd_gltf_open_within(file_input *input, const ffd_source *source, const memory_budget *budget,
                                mesh_document **document, ffd_error *error);

#endif
