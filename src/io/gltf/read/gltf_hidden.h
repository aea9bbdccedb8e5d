/* gltf_hidden.h - the text that tinygltf gets: that of the file, without what it cannot read as we need it.
 */
#ifndef FFD_IO_GLTF_READ_GLTF_HIDDEN_H
#define FFD_IO_GLTF_READ_GLTF_HIDDEN_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

/* Edits an integer that is not written in plain digits ("12.0", "1e3", "-0"): tinygltf refuses it, or takes a
   default in its place. */
void ffd_gltf_show_integer(const json_tree *tree, uint32_t value, double number, json_edits *edits);

/* Writes the text. edits: the integers that ffd_gltf_show_integer edited; all that is hidden is added.
   Returns false if memory runs out. */
bool ffd_gltf_write_shown(const gltf_document *document, json_edits *edits, byte_buffer *text);

#endif
