/* info_mesh.h - describes a mesh for `ffd info`. */
#ifndef FFD_JOB_INFO_MESH_H
#define FFD_JOB_INFO_MESH_H

#include "mesh/mesh.h"

/* Appends the members that describe a mesh to an open JSON object. Errors: those of opening it. */
ffd_status ffd_info_mesh(const ffd_info_desc *desc, json_text *json, ffd_error *error);

/* The same for an open mesh. */
ffd_status ffd_info_document(const mesh_document *document, json_text *json, ffd_error *error);

#endif
