/* gltf_container.h - how the output holds each buffer. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_CONTAINER_H
#define FFD_IO_GLTF_SAVE_GLTF_CONTAINER_H

#include "io/gltf/save/gltf_saver.h"

/* Chooses the kind of each new buffer. A .gltf that becomes a GLB has its first buffer in the BIN chunk
   and the other files as data URIs, so that it is one file; a GLB that becomes a .gltf has its BIN
   chunk in a file beside it, on standard output in a data URI. */
void ffd_gltf_choose_buffer_kinds(gltf_saver *saver);

/* Edits the JSON of the buffers whose kind changed, but for the names of files. */
void ffd_gltf_move_buffers(gltf_saver *saver);

/* Adds the member "uri" to a buffer's object. */
void ffd_gltf_add_uri(gltf_saver *saver, size_t buffer, const char *uri);

#endif
