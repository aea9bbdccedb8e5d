/* rational_volume.h - the signed volume of a rational lattice at rest (src/maths.md 10.5). */
#ifndef FFD_EMBED_FRAME_RATIONAL_VOLUME_H
#define FFD_EMBED_FRAME_RATIONAL_VOLUME_H

#include "lattice/lattice.h"

/* The integral of det J over the domain at rest is triple * 2^exponent / 3. */
typedef struct rational_volume {
    double triple;
    double doubt; /* bound of the error of triple; may be infinite */
    int exponent;
} rational_volume;

/* Computes the volume of a lattice with weights. Takes at most 2^14 parts of the faces and 256 for each of
   their cells; where more would be needed, because weights differ by 1e20 or so, the doubt says so. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_rational_volume(const ffd_lattice *lattice, rational_volume *volume, ffd_error *error);

#endif
