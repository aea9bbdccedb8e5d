/* info_parts.h - lists the names of a mesh that `--only` accepts. */
#ifndef FFD_JOB_INFO_PARTS_H
#define FFD_JOB_INFO_PARTS_H

#include "mesh/mesh.h"

/* Appends to an open JSON object every name that `--only` accepts and, separately, the things without a name,
   each with bounds and numbers of vertices and faces. Things that this build cannot read do not keep the rest
   from being listed. Errors: FFD_E_MEMORY, and those of reading the file. */
ffd_status ffd_info_parts(const mesh_document *document, json_text *json, ffd_error *error);

#endif
