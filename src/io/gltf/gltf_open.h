/* gltf_open.h - opens and closes a glTF document. */
#ifndef FFD_IO_GLTF_GLTF_OPEN_H
#define FFD_IO_GLTF_GLTF_OPEN_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's open, close and list_files. */
mesh_open_function ffd_gltf_open;
mesh_close_function ffd_gltf_close;
mesh_list_files_function ffd_gltf_list_files;

/* Opens like ffd_gltf_open, but with a memory budget that other documents share. */
ffd_status ffd_gltf_open_within(file_input *input, const ffd_source *source, const memory_budget *budget,
                                mesh_document **document, ffd_error *error);

#endif
