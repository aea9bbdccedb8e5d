/* part.h - a lattice with its moves as offsets, or one of its two states alone. */
#ifndef FFD_AUTHOR_PART_H
#define FFD_AUTHOR_PART_H

#include <ffd/job.h>

/* Makes a lattice of the same map without moves (FFD_PART_BOTH), or one that moves nothing: as it is at rest,
   or with the deformed control points and weights at rest. The caller destroys *result. Errors: FFD_E_INVALID
   for a box that is not laid round a mesh yet, where positions are needed; FFD_E_MEMORY. */
ffd_status ffd_lattice_take_part(const ffd_lattice *lattice, ffd_lattice_part part, ffd_lattice **result,
                                 ffd_error *error);

#endif
