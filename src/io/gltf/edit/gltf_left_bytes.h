/* gltf_left_bytes.h - counts the bytes of a file that nothing uses any more. They stay in the file, because
   other data may follow them. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_LEFT_BYTES_H
#define FFD_IO_GLTF_EDIT_GLTF_LEFT_BYTES_H

#include "io/gltf/read/gltf_document.h"

/* Counts the bytes of accessors that were used before (dropped[a] for accessor a) and have no users now:
   their elements, sparse values and indices, compressed bytes. A byte counts once. It does not count if
   something else uses it: another accessor with users, an image, data of an extension. Returns false if
   memory runs out. */
bool ffd_gltf_count_left_bytes(const gltf_document *document, const bool *dropped, const unsigned char *users,
                               uint64_t *bytes);

/* Warns of the bytes that a replaced morph target leaves unused, and adds them to *bytes. These are the bytes
   of the accessors a < count with before[a] > 0 (ffd_gltf_count_users) that have no users now. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_left(const gltf_document *document, const unsigned char *before, size_t count,
                                 const char *name, const mesh_log *log, uint64_t *bytes, ffd_error *error);

#endif
