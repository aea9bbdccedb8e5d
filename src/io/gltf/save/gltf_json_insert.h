/* gltf_json_insert.h - inserts elements at the end of JSON lists. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_JSON_INSERT_H
#define FFD_IO_GLTF_SAVE_GLTF_JSON_INSERT_H

#include "io/gltf/save/gltf_saver.h"

/* Adds elements (their text, with commas between) to a top-level list, which is created if missing. Only a
   list that is not empty can be added to more than once. */
void ffd_gltf_add_elements(gltf_saver *saver, const gltf_values *list, const char *key,
                           const byte_buffer *text);

/* Adds the saver's new buffer, if any, to "buffers". */
void ffd_gltf_add_buffer(gltf_saver *saver);

/* Inserts a text after the last member of an array or object, with a comma if needed. Call it at most once
   per container. */
void ffd_gltf_insert_last(gltf_saver *saver, uint32_t container, const byte_buffer *text);

#endif
