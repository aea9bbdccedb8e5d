/* keys.h - the control points of a lattice with keys at a time. */
#ifndef FFD_LATTICE_KEYS_H
#define FFD_LATTICE_KEYS_H

#include "lattice/moves.h"

/* A time among keys: that of key `first`, if part is 0; else so far from it towards the next, 0 < part < 1.
 */
typedef struct key_place {
    size_t first;
    double part;
} key_place;

/* Returns the place of the time of the keys. Before the first key it is that key's, after the last the last
   one's. */
key_place ffd_keys_find(const spec_keys *keys);

/* Returns the value between two keys: a to the bit, if both are the same. */
static inline double ffd_keys_mix(double part, double a, double b)
{
    return a + part * (b - a);
}

/* Sets the control points and their weights to those of the keys (KEYS_POINTS) at their time. The lattice has
   its rest and, in deformed and difference, what its keys start from. region: as for ffd_moves_apply. Errors:
   those of ffd_moves_apply. */
ffd_status ffd_keys_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                          ffd_error *error);

#endif
