/* spec_still.h - the content of a lattice file without moves or keys: a lattice as it is. */
#ifndef FFD_LATTICE_FILE_SPEC_STILL_H
#define FFD_LATTICE_FILE_SPEC_STILL_H

#include "lattice/lattice.h"
#include "lattice/spec.h"

/* Turns spec, a copy of that of a lattice whose time was chosen, which shares its arrays, into one without
   keys that is the same lattice. *own: an array of it that the caller frees. Errors: FFD_E_INVALID for one
   that needs positions and has none, FFD_E_MEMORY. */
ffd_status ffd_spec_still(const ffd_lattice *lattice, lattice_spec *spec, double **own, ffd_error *error);

/* Sets the deformed control points of a copy of a lattice's spec, which shares its arrays, to those of the
   lattice, in place of moves and keys. */
void ffd_spec_bake(const ffd_lattice *lattice, lattice_spec *spec);

#endif
