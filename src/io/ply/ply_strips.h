/* ply_strips.h - the triangles of a PLY file's triangle strips: element tristrips, with a list of vertices.
   Each vertex makes a triangle with the two before it, with every second triangle reversed; -1 begins a new
   strip (as in the Stanford models). Degenerate triangles, which name a vertex twice, only join strips and
   are left out. */
#ifndef FFD_IO_PLY_PLY_STRIPS_H
#define FFD_IO_PLY_PLY_STRIPS_H

#include "io/ply/ply_document.h"

/* Called for each triangle. Returns false if memory ran out. */
typedef bool ply_triangle_visitor(void *context, const uint32_t corners[3]);

/* Visits the triangles in the order of the file. Errors: FFD_E_INVALID for a vertex that does not exist,
   FFD_E_MEMORY. */
ffd_status ffd_ply_visit_strips(const ply_document *document, ply_triangle_visitor *visit, void *context,
                                ffd_error *error);

#endif
