/* gltf_announce.h - log lines that summarize saving. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_ANNOUNCE_H
#define FFD_IO_GLTF_WRITE_GLTF_ANNOUNCE_H

#include "io/gltf/write/gltf_saver.h"

/* Warns of JSON values with their count, each once, and names the first three. values: uint32_t each, which
   are sorted. Returns the count. If memory runs out, saver->edits fail. */
size_t ffd_gltf_warn_of_values(gltf_saver *saver, byte_buffer *values, const char *one, const char *many);

/* Logs what was left unchanged, copied or stored in another way. Call it after all edits. */
void ffd_gltf_announce(const gltf_saver *saver);

#endif
