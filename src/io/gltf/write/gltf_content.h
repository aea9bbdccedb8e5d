/* gltf_content.h - makes the new bytes of the buffers. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_CONTENT_H
#define FFD_IO_GLTF_WRITE_GLTF_CONTENT_H

#include "io/gltf/write/gltf_saver.h"

/* Makes saver->buffers from the plan, with their overwrites, appends and lengths. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error);

/* Frees saver->buffers. */
void ffd_gltf_free_content(gltf_saver *saver);

/* Returns the buffer to which the copy of an accessor is appended. */
size_t ffd_gltf_append_buffer(const gltf_document *document, size_t accessor);

/* Returns the number of bytes of a buffer's new content. It exceeds the buffer's length if the old content
   did and has not grown. */
size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer);

/* Reads bytes [offset, offset + size) of the new content. */
void ffd_gltf_content_read(const gltf_saver *saver, size_t buffer, size_t offset, size_t size,
                           unsigned char *bytes);

/* Returns how many bytes of the new content from offset on lie in memory exactly as written, in the old
   content or in the results, and points *bytes to them. 0: use ffd_gltf_content_read. */
size_t ffd_gltf_content_at(const gltf_saver *saver, size_t buffer, size_t offset,
                           const unsigned char **bytes);

#endif
