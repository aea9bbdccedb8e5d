/* gltf_schema.h - checks the types and ranges of the values of a glTF file that we use (glTF 2.0, 5).
   tinygltf silently uses a default for a value of the wrong type, and truncates large integers: such
   files are refused here. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SCHEMA_H
#define FFD_IO_GLTF_MODEL_GLTF_SCHEMA_H

#include "json/json_edit.h"
#include "json/json_span.h"

/* Checks them. For an integer that is not written as plain digits ("12.0" is allowed), an edit to plain
   digits is added to plain; byteStride and mode, which the caller reads itself, become 4 in it. Errors:
   FFD_E_INVALID, FFD_E_UNSUPPORTED (another version of glTF). */
ffd_status ffd_gltf_check_schema(const json_span *tree, const char *name, json_edits *plain,
                                 ffd_error *error);

#endif
