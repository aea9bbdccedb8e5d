/* gltf_schema.h - checks the types and ranges of the values that the program uses of a glTF file (glTF 2.0,
   5). tinygltf would silently replace a value of the wrong type by a default, and truncate large integers:
   such files are refused here. */
#ifndef FFD_IO_GLTF_READ_GLTF_SCHEMA_H
#define FFD_IO_GLTF_READ_GLTF_SCHEMA_H

#include "base/memory/intern.h"
#include "json/json_edit.h"
#include "json/json_tree.h"

/* Checks the values, and edits integers for tinygltf (gltf_hidden.h). Errors: FFD_E_INVALID,
   FFD_E_UNSUPPORTED (another version of glTF), FFD_E_LIMIT (a size beyond the largest). */
ffd_status ffd_gltf_check_schema(const json_tree *tree, const char *name, json_edits *integers,
                                 ffd_error *error);

/* Whether the file lists an extension as used. Takes time in proportion to the list. */
bool ffd_gltf_uses(const json_tree *tree, const char *extension);
/* Adds the names in that list to a table, for many questions. Returns false if memory runs out. */
bool ffd_gltf_list_used(const json_tree *tree, intern_table *names);

#endif
