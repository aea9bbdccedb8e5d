/* view_inputs.h - the inputs of a view, which its output must not replace. */
#ifndef FFD_JOB_VIEW_VIEW_INPUTS_H
#define FFD_JOB_VIEW_VIEW_INPUTS_H

#include "mesh/mesh.h"

/* Refuses an output that is a mesh, a lattice or the embedding of the view (FFD_E_EXISTS). */
ffd_status ffd_view_check_inputs(const ffd_view_desc *desc, ffd_error *error);
/* Likewise for the files that an open mesh refers to: buffers, images, material libraries. Errors also:
   FFD_E_MEMORY. */
ffd_status ffd_view_check_files(const ffd_source *source, const mesh_document *document, const char *output,
                                ffd_error *error);

#endif
