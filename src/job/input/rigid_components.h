/* rigid_components.h - the connected components of a mesh, each of which moves as one piece. */
#ifndef FFD_JOB_INPUT_RIGID_COMPONENTS_H
#define FFD_JOB_INPUT_RIGID_COMPONENTS_H

#include "mesh/mesh.h"

/* Numbers the connected components of the selected and used vertices whose piece is MESH_NONE, in the order
   of their first vertices, and lets their pieces be these numbers, from `piece` on. They are joined by faces
   and lines, and at equal positions. *end: behind the last one. Errors: FFD_E_LIMIT, FFD_E_MEMORY, those of
   the deadline and of reading faces. */
ffd_status ffd_rigid_components_find(mesh_document *document, mesh_state state, int threads, uint32_t piece,
                                     uint32_t *pieces, uint32_t *end, ffd_error *error);

#endif
