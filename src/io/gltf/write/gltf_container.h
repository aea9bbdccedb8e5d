/* gltf_container.h - decides how the output stores each buffer. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_CONTAINER_H
#define FFD_IO_GLTF_WRITE_GLTF_CONTAINER_H

#include "io/gltf/write/gltf_saver.h"

/* Chooses the kind of each new buffer. If a .gltf becomes a GLB, its first buffer goes into the BIN chunk and
   the other files become data URIs, so that the result is one file. If a GLB becomes a .gltf, its BIN chunk
   goes into a file beside it; on standard output, into a data URI. */
void ffd_gltf_choose_buffer_kinds(gltf_saver *saver);

/* Edits the JSON of buffers whose kind changed, except the names of files. */
void ffd_gltf_move_buffers(gltf_saver *saver);

/* Adds the member "uri" to the JSON of a buffer. */
void ffd_gltf_add_uri(gltf_saver *saver, size_t buffer, const char *uri);

#endif
