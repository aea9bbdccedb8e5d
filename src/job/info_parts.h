/* info_parts.h - the names of a mesh that `--only` takes. */
#ifndef FFD_JOB_INFO_PARTS_H
#define FFD_JOB_INFO_PARTS_H

#include "mesh/mesh.h"

/* Appends to an open JSON object every name that `--only` takes, and apart from them what has none, with
   bounds and numbers of vertices and faces. What this build cannot read does not keep the rest from being
   described. Errors: FFD_E_MEMORY, and what is found in the file. */
ffd_status ffd_info_parts(const mesh_document *document, json_text *json, ffd_error *error);

#endif
