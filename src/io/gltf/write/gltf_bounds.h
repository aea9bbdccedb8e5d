/* gltf_bounds.h - edits "min" and "max" of accessors whose content changes. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_BOUNDS_H
#define FFD_IO_GLTF_WRITE_GLTF_BOUNDS_H

#include "io/gltf/write/gltf_saver.h"

/* Edits the bounds of the accessor that a version overwrites, if it has bounds. */
void ffd_gltf_edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits);

/* Edits the bounds of an accessor that is written decompressed, and does not change else. */
void ffd_gltf_edit_unpacked_bounds(const gltf_saver *saver, const gltf_unpacking *unpacking,
                                   json_edits *edits);

#endif
