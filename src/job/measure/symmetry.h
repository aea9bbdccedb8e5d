/* symmetry.h - whether the mesh is symmetric to the planes that mirrored moves take by default. */
#ifndef FFD_JOB_MEASURE_SYMMETRY_H
#define FFD_JOB_MEASURE_SYMMETRY_H

#include "job/measure/job_state.h"

/* Warns, once for each lattice and axis, of a mirrored move without a plane of its own where fewer than 99 in
   100 vertices have a mirror image in the plane through the middle of the lattice. To be called before the
   vertices are deformed. Where the memory allowed does not suffice nothing is said. Errors: FFD_E_MEMORY, and
   those of a pass. */
ffd_status ffd_symmetry_warn(const deform_job *job, ffd_error *error);

#endif
