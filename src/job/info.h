/* info.h - the parts of what `ffd info` prints, each in a source of its own: boxes (info_box.c), lattice
   files (info_lattice.c), layers of control points (info_layers.c), meshes (info_mesh.c), the names that
   --only accepts (info_parts.c), all of it as text for people (info_text.c). */
#ifndef FFD_JOB_INFO_H
#define FFD_JOB_INFO_H

#include "base/fail.h"
#include "mesh/mesh.h"
#include "json/json_text.h"
#include <ffd/job.h>
#include <stddef.h>

/* Appends "key": {"min": [..], "max": [..]}, or null if there are no points. */
void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *box);

/* Appends the box of a lattice to an open JSON object: the meshes that it goes round, its margin, sides and
   axes. Nothing if the lattice has no box. fits: fit a lattice round named meshes to them. like: options for
   reading meshes. box: filled with the bounds; min > max if unknown (a mesh to come, meshes that cannot be
   read - the text says why - or no box). Errors: FFD_E_MEMORY. */
ffd_status ffd_info_box(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                        json_text *json, ffd_error *error);

/* Appends the position of each layer along u, v and w to an open JSON object. Of a box: the coordinate along
   its axis, or the fraction of its side if box is empty (a mesh to come). Of a cylinder: radius, angle in
   degrees, height from the middle. Layers beyond the box are counted. */
void ffd_info_layers(const ffd_lattice *lattice, const ffd_bounds *box, json_text *json);

/* Appends the members that describe the lattice file to an open JSON object. Errors: those of loading it, and
   FFD_E_INVALID for a value without a placeholder. */
ffd_status ffd_info_lattice(const ffd_info_desc *desc, json_text *json, ffd_error *error);

/* Appends to an open JSON object every name that `--only` accepts and, separately, the things without a name,
   each with bounds and numbers of vertices and faces. Things that this build cannot read do not keep the rest
   from being listed. Errors: FFD_E_MEMORY, and those of reading the file. */
ffd_status ffd_info_parts(const mesh_document *document, json_text *json, ffd_error *error);

/* Appends the members that describe a mesh to an open JSON object. Errors: those of opening it. */
ffd_status ffd_info_mesh(const ffd_info_desc *desc, json_text *json, ffd_error *error);

/* The same for an open mesh. */
ffd_status ffd_info_document(const mesh_document *document, json_text *json, ffd_error *error);

/* Renders a JSON object (size bytes) as aligned lines: a member a line, the members of an inner object
   indented below its name, "format" and "version" left out. *text is freed with ffd_free. */
ffd_status ffd_info_render(const char *json, size_t size, char **text, ffd_error *error);

#endif
