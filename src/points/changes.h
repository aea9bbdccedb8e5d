/* changes.h - directional derivatives of embedded points. Declares by_weights.c. */
#ifndef FFD_POINTS_CHANGES_H
#define FFD_POINTS_CHANGES_H

#include "points/point_run.h"
#include "points/row_tangent.h"

/* Computes the derivatives of the points along changes of the deformed control points and weights.
   moved: the deformed volume. dx: 3 numbers for each change of each point; those by change k of point i
   are dx[(3 i + c) count + k]. Errors: FFD_E_ARGUMENT, FFD_E_INVALID (another lattice), FFD_E_CANCELLED,
   FFD_E_MEMORY. */
ffd_status ffd_embedding_changes(const ffd_embedding *embedding, const ffd_lattice *moved,
                                 const control_change *changes, size_t count, double *dx,
                                 const ffd_run_options *options, ffd_error *error);

#endif
