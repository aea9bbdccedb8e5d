/* lattice_new.h - a new lattice round meshes. */
#ifndef FFD_JOB_LATTICE_NEW_H
#define FFD_JOB_LATTICE_NEW_H

#include <ffd/job.h>

/* Makes a lattice as ffd_lattice_new_run does, without writing it. Meshes in memory are registered. Errors:
   those of reading a mesh and of ffd_lattice_create. */
ffd_status ffd_lattice_new_round(const ffd_lattice_new_desc *desc, ffd_lattice **lattice, ffd_error *error);

#endif
