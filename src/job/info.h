/* info.h - the parts of `ffd info`: each appends members to an open JSON object. */
#ifndef FFD_JOB_INFO_H
#define FFD_JOB_INFO_H

#include "mesh/mesh.h"

ffd_status ffd_info_mesh(const ffd_source *source, json_text *json, ffd_error *error);
ffd_status ffd_info_lattice(const char *path, json_text *json, ffd_error *error);

/* The same for a mesh that is open. */
ffd_status ffd_info_document(const mesh_document *document, json_text *json, ffd_error *error);

/* "key": {"min": [..], "max": [..]}, or null where min > max. */
void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *bounds);

/* Bounds of nothing, and widened to hold a point (finite coordinates). */
ffd_bounds ffd_info_no_bounds(void);
void ffd_info_widen(ffd_bounds *bounds, const double point[3]);

/* Renders the JSON object (size bytes) as aligned lines, a member a line, the members of an inner object
   below its name; "format" and "version" are left out. *text is freed with ffd_text_free. */
ffd_status ffd_info_render(const char *json, size_t size, char **text, ffd_error *error);

#endif
