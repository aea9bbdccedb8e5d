/* rest_hash.h - identifies the rest volume of an embedding. */
#ifndef FFD_LATTICE_REST_HASH_H
#define FFD_LATTICE_REST_HASH_H

#include "base/memory/hash.h"
#include "lattice/lattice.h"

/* Hashes what determines u,v,w, and nothing of the deformed volume. For each direction: degree, number of
   control points, closed (1 or 0), seam between first and last face (1 or 0; lattice/border.h), number of
   knots (8 bytes each), hash of the knots. Then the hash of the rest points and, if a rest weight is not 1,
   the hash of the weights. The lattice must have control points. */
hash128 ffd_rest_hash(const ffd_lattice *lattice);

/* Returns whether two lattices have equal rest volumes, that is, whether their hashes would be equal.
   Compares the arrays directly, which is faster than hashing. */
bool ffd_rest_equal(const ffd_lattice *a, const ffd_lattice *b);

#endif
