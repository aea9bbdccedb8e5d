/* selection.h - what `--only` leaves of a mesh. */
#ifndef FFD_JOB_INPUT_SELECTION_H
#define FFD_JOB_INPUT_SELECTION_H

#include "mesh/mesh.h"

/* Lets the document move only what the selectors (count) name; name is the mesh's in messages. Does nothing
   without selectors. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY, and what the format finds in the file. */
ffd_status ffd_selection_apply(const char *const *only, size_t count, const char *name,
                               mesh_document *document, ffd_error *error);

/* Drops the faces that have a vertex which is not selected. Errors: FFD_E_MEMORY. */
ffd_status ffd_selection_reduce(const mesh_document *document, mesh_faces *faces, ffd_error *error);

/* Whether all vertices of the document are selected. */
bool ffd_selection_is_all(const mesh_document *document);

#endif
