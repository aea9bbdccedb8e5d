/* gltf_content_write.h - writes the new bytes of a buffer. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_CONTENT_WRITE_H
#define FFD_IO_GLTF_WRITE_GLTF_CONTENT_WRITE_H

#include "io/gltf/write/gltf_saver.h"

/* Writes a buffer's new content to the output, as base64 or unchanged. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_gltf_write_content(const gltf_saver *saver, size_t buffer, bool base64, ffd_error *error);

#endif
