/* glb_origin.h - chooses the translations of a new glTF file's nodes, so that floats keep a shape far from
   the origin. */
#ifndef FFD_IO_WRITE_GLB_ORIGIN_H
#define FFD_IO_WRITE_GLB_ORIGIN_H

#include "io/write/glb_plan.h"

/* Makes the translations of the nodes, 3 numbers for each mesh, relative to which positions are then stored;
   free them with ffd_free, after an error too. All are zero if the step of floats at the largest coordinate
   is at most 1e-6 of the diagonal. Otherwise the coordinates are multiples of a unit, the next power of two
   above the diagonal: on each axis the multiple nearest to the middle. So parts of the same size that lie
   side by side mostly have the same translation. A mesh whose own shape would still be lost
   (mesh/precision.h) gets one by its own diagonal in the same way. Errors: FFD_E_MEMORY. */
ffd_status ffd_glb_origins(const glb_plan *plan, double **origins, ffd_error *error);

#endif
