/* gltf_overlap.h - finds bytes that several accessors share. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_OVERLAP_H
#define FFD_IO_GLTF_WRITE_GLTF_OVERLAP_H

#include "io/gltf/write/gltf_plan.h"

/* Withdraws the in-place versions that would change bytes which another user needs unchanged. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_resolve_overlaps(const gltf_document *document, gltf_plan *plan, ffd_error *error);

#endif
