/* selection.h - applies `--only` to a mesh. */
#ifndef FFD_JOB_INPUT_SELECTION_H
#define FFD_JOB_INPUT_SELECTION_H

#include "mesh/mesh.h"
#include "mesh/selector.h"

/* Restricts the document's movable vertices to those that the selectors name. count: number of selectors; 0:
   no restriction. name: of the mesh, for messages. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY, and those of the
   format. */
ffd_status ffd_selection_apply(const char *const *only, size_t count, const char *name,
                               mesh_document *document, ffd_error *error);

/* Removes the faces that have an unselected vertex. Errors: FFD_E_MEMORY. */
ffd_status ffd_selection_reduce(const mesh_document *document, mesh_faces *faces, ffd_error *error);

/* Whether all vertices of the document are selected. */
bool ffd_selection_is_all(const mesh_document *document);

#endif
