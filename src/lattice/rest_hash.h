/* rest_hash.h - by which an embedding knows the rest volume that it was made of. */
#ifndef FFD_LATTICE_REST_HASH_H
#define FFD_LATTICE_REST_HASH_H

#include "base/memory/hash.h"
#include "lattice/lattice.h"

/* Hashes what decides u,v,w, and nothing of what is moved. For each direction: degree, number of control
   points, 1 if closed or else 0, 1 if its first and last face are a seam (lattice/border.h) or else 0, number
   of knots (8 bytes each) and the hash of the knots; then the hash of the rest points; then, where a rest
   weight is not 1, the hash of the weights. The lattice must be fitted to its mesh. */
hash128 ffd_rest_hash(const ffd_lattice *lattice);

/* Whether two lattices have the rest volume that their hashes are of; as fast as reading both. */
bool ffd_rest_equal(const ffd_lattice *a, const ffd_lattice *b);

#endif
