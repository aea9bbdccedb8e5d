/* view_order.h - which vertices of two files of one mesh are the same: the later file may list its parts in
   another order. */
#ifndef FFD_JOB_VIEW_VIEW_ORDER_H
#define FFD_JOB_VIEW_VIEW_ORDER_H

#include "mesh/mesh.h"

/* Finds the vertex of `after` that each vertex of `before` is, by what shows them: nodes of a glTF that got
   copies of their meshes have these behind all others. Both have as many vertices. order: the caller's to
   free; NULL where the vertices have the same order, or where the parts of the two cannot be matched. Errors:
   FFD_E_LIMIT (the memory budget of after), FFD_E_MEMORY. */
ffd_status ffd_view_match_parts(const mesh_document *before, mesh_document *after, size_t **order,
                                ffd_error *error);

#endif
