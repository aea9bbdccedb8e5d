/* seal.h - what can be held of a lattice (public: ffd_lattice_seal in ffd/author.h). */
#ifndef FFD_AUTHOR_SEAL_H
#define FFD_AUTHOR_SEAL_H

#include <ffd/author.h>

/* Checks the arguments of ffd_lattice_seal. Errors: FFD_E_ARGUMENT, as there. */
ffd_status ffd_seal_check(const ffd_lattice *lattice, int k, unsigned faces, ffd_error *error);

#endif
