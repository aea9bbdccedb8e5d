/* copy.h - a copy of what a lattice's file says. */
#ifndef FFD_LATTICE_COPY_H
#define FFD_LATTICE_COPY_H

#include "lattice/spec.h"

/* NULL if memory runs out. */
lattice_spec *ffd_spec_copy(const lattice_spec *spec);

#endif
