/* gltf_json_insert.h - inserts elements at the end of JSON lists. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_JSON_INSERT_H
#define FFD_IO_GLTF_EDIT_GLTF_JSON_INSERT_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

/* Adds elements (their text, with commas between) to a top-level list, which is created if missing. Only a
   list that is not empty can be added to more than once. */
void ffd_gltf_add_elements(const gltf_document *document, const gltf_values *list, const char *key,
                           const byte_buffer *text, json_edits *edits);

/* Adds a buffer to "buffers". is_data: its URI holds the data. */
void ffd_gltf_add_buffer(const gltf_document *document, size_t length, bool is_data, json_edits *edits);

/* Inserts a text after the last member of an array or object, with a comma if needed. Call it at most once
   per container. */
void ffd_gltf_insert_last(const gltf_document *document, uint32_t container, const byte_buffer *text,
                          json_edits *edits);

#endif
