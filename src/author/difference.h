/* difference.h - how far the maps of two lattices are apart. */
#ifndef FFD_AUTHOR_DIFFERENCE_H
#define FFD_AUTHOR_DIFFERENCE_H

#include "lattice/lattice.h"
#include <stdint.h>

/* Finds the largest difference of a coordinate of C of two lattices with the same domain, at rest and
   deformed, at 3 places of each non-empty span of b in each direction. Without control points (a box round a
   mesh that is not known yet) only offsets are compared. The result does not depend on threads. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_lattice_difference(const ffd_lattice *a, const ffd_lattice *b, int threads, double *largest,
                                  ffd_error *error);

/* Returns the bytes that each thread takes for that. */
uint64_t ffd_lattice_difference_bytes(const ffd_lattice *a, const ffd_lattice *b);

#endif
