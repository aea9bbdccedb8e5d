/* copy.h - copies the spec of a lattice. */
#ifndef FFD_LATTICE_COPY_H
#define FFD_LATTICE_COPY_H

#include "lattice/spec.h"

/* Returns a copy; NULL if memory runs out. */
lattice_spec *ffd_spec_copy(const lattice_spec *spec);

#endif
