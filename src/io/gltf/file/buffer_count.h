/* buffer_count.h - how many buffers of a glTF file are files of their own, without reading the file as a
 * model. */
#ifndef FFD_IO_GLTF_FILE_BUFFER_COUNT_H
#define FFD_IO_GLTF_FILE_BUFFER_COUNT_H

#include <stddef.h>

/* Counts the buffers of a JSON text that have a URI which is no data URI, in no memory. Of a text that is not
   valid JSON any number. */
size_t ffd_gltf_count_buffer_files(const char *text, size_t size);

#endif
