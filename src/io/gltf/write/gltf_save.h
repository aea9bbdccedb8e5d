/* gltf_save.h - writes a document with its results. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_SAVE_H
#define FFD_IO_GLTF_WRITE_GLTF_SAVE_H

#include "io/gltf/read/gltf_document.h"

/* Saves a document with its results in place of the deformed attributes; otherwise as mesh_format's save. */
mesh_save_function ffd_gltf_save_results;

#endif
