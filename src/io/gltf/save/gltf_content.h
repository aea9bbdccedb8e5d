/* gltf_content.h - the new bytes of the buffers. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_CONTENT_H
#define FFD_IO_GLTF_SAVE_GLTF_CONTENT_H

#include "io/gltf/save/gltf_saver.h"

/* Makes saver->buffers with their overwrites, appends and lengths from the plan. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error);

/* Frees saver->buffers. */
void ffd_gltf_free_content(gltf_saver *saver);

/* Returns the buffer that an accessor's copy is appended to. */
size_t ffd_gltf_append_buffer(const gltf_document *document, size_t accessor);

/* Returns the number of bytes of a buffer's new content: more than its length if the old content had
   more and did not grow. */
size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer);

/* Reads bytes [offset, offset + size) of the new content. */
void ffd_gltf_content_read(const gltf_saver *saver, size_t buffer, size_t offset, size_t size,
                           unsigned char *bytes);

/* Returns how many bytes of the new content from offset on are in memory as they are to be written, in
   the old content or among the results, and points *bytes to them. 0: they must be read. */
size_t ffd_gltf_content_at(const gltf_saver *saver, size_t buffer, size_t offset,
                           const unsigned char **bytes);

#endif
