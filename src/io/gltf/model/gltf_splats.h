/* gltf_splats.h - the Gaussian splats of a glTF file (KHR_gaussian_splatting): their rotations, scales and
   spherical harmonics, and the results of these. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SPLATS_H
#define FFD_IO_GLTF_MODEL_GLTF_SPLATS_H

#include "io/gltf/read/gltf_document.h"

/* Marks the parts whose vertices are splats. If the file's rotations and scales can be changed, also prepares
   their results. Call it after the parts and shapes are made. Notes scales that are logarithms. Errors: those
   of a flaw, FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_find_splats(gltf_document *document, ffd_error *error);

/* Allocates the results of selected splats and, after ffd_gltf_follow, of unselected splats whose nodes have
   moved. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_begin_splats(gltf_document *document, ffd_error *error);

/* Warns of splats whose harmonics could not be turned. */
void ffd_gltf_warn_of_splats(const gltf_document *document, const mesh_log *log);

#endif
