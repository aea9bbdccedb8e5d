/* buffer_count.h - counts the buffers of a glTF file that are files of their own, without parsing the
   file. */
#ifndef FFD_IO_GLTF_FILE_BUFFER_COUNT_H
#define FFD_IO_GLTF_FILE_BUFFER_COUNT_H

#include <stddef.h>

/* Counts the buffers of a JSON text that have a URI other than a data URI. Allocates nothing. The result for
   invalid JSON is arbitrary. */
size_t ffd_gltf_count_buffer_files(const char *text, size_t size);

#endif
