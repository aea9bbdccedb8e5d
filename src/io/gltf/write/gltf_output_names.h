/* gltf_output_names.h - chooses the names of the buffers' files. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_OUTPUT_NAMES_H
#define FFD_IO_GLTF_WRITE_GLTF_OUTPUT_NAMES_H

#include "io/gltf/write/gltf_saver.h"

/* Chooses the names and edits the buffers' URIs. Errors: FFD_E_EXISTS, FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_gltf_name_buffers(gltf_saver *saver, ffd_error *error);

/* mesh_format's count_beside: the files of the buffers. */
mesh_count_beside_function ffd_gltf_count_beside;

#endif
