/* lattice_time.h - lattices with keys at a time (public: ffd/lattice.h). */
#ifndef FFD_LATTICE_FILE_LATTICE_TIME_H
#define FFD_LATTICE_FILE_LATTICE_TIME_H

#include "lattice/lattice.h"
#include "lattice/spec.h"

/* Finds out whether a lattice file or text has keys, and whether its moves have a placeholder. A broken one
   has neither. */
void ffd_lattice_look(const ffd_lattice_source *source, const ffd_setting *placeholder, bool *has_keys,
                      bool *has_placeholder);

/* Whether a lattice has keys. */
bool ffd_lattice_has_keys(const ffd_lattice *lattice);

/* Replaces a lattice with keys by the same one of its time, without keys. The old one stays after a failure.
   Errors: those of ffd_spec_still. */
ffd_status ffd_lattice_make_still(ffd_lattice **lattice, ffd_error *error);

#endif
