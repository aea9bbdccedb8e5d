/* gltf_patch.h - edits the JSON as the plan and the new buffers require. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_PATCH_H
#define FFD_IO_GLTF_WRITE_GLTF_PATCH_H

#include "io/gltf/write/gltf_saver.h"

/* Makes and logs these edits. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_make_edits(gltf_saver *saver, ffd_error *error);

#endif
