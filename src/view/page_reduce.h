/* page_reduce.h - simplifies a page's mesh to a number of vertices that a browser can open. */
#ifndef FFD_VIEW_PAGE_REDUCE_H
#define FFD_VIEW_PAGE_REDUCE_H

#include "view/page_mesh.h"

/* Simplifies each part of a mesh that is not numbered yet, by its shape before the deformation, until the
   mesh uses at most limit vertices. Borders of parts and triangles at torn edges are kept as far as that
   allows. Segments and points are thinned out evenly. Does nothing if the mesh is within the limit. Errors:
   FFD_E_UNSUPPORTED (meshoptimizer is missing), FFD_E_MEMORY. */
ffd_status ffd_page_reduce(page_mesh *mesh, size_t limit, ffd_error *error);

#endif
