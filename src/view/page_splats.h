/* page_splats.h - the Gaussian splats of a page: for each vertex its covariance in 16 bytes, a float for the
   largest entry and 6 numbers of 16 bits relative to it. */
#ifndef FFD_VIEW_PAGE_SPLATS_H
#define FFD_VIEW_PAGE_SPLATS_H

#include "view/page_mesh.h"
#include "view/page_writer.h"

/* Writes the blocks of an indexed mesh (ffd_page_mesh_index): those before; and those after, where they
   differ. None for a mesh without splats. */
void ffd_page_splats_write(const page_mesh *mesh, page_writer *w);

#endif
