/* gltf_left_bytes.h - the bytes that stay in a file although nothing uses them any more. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_LEFT_BYTES_H
#define FFD_IO_GLTF_MORPH_GLTF_LEFT_BYTES_H

#include "io/gltf/document/gltf_document.h"

/* Counts the bytes of accessors that are not used any more, dropped[a] for accessor a: their elements and,
   where they are sparse, what is stored of these; a compressed view where no other accessor has a part of it.
   Other views may begin behind them, so that they cannot go. False: no memory. */
bool ffd_gltf_count_left_bytes(const gltf_document *document, const bool *dropped, uint64_t *bytes);

/* Says how many bytes are left of a morph target that was replaced, and adds them to *bytes: those of
   accessors that had users before, of the first `count` ones, and have none now (ffd_gltf_count_users).
   Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_left(const gltf_document *document, const unsigned char *before, size_t count,
                                 const char *name, const mesh_log *log, uint64_t *bytes, ffd_error *error);

#endif
