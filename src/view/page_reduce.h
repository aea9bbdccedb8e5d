/* page_reduce.h - a page's mesh with fewer vertices, which a browser still opens. */
#ifndef FFD_VIEW_PAGE_REDUCE_H
#define FFD_VIEW_PAGE_REDUCE_H

#include "view/page_mesh.h"

/* Simplifies each part of a mesh that is not numbered yet, by the shape before, until it uses at most limit
   vertices; a part's borders stay, and the triangles at torn edges. Segments and points are thinned out.
   Does nothing where it has no more. Errors: FFD_E_UNSUPPORTED (no meshoptimizer), FFD_E_MEMORY. */
ffd_status ffd_page_reduce(page_mesh *mesh, size_t limit, ffd_error *error);

#endif
