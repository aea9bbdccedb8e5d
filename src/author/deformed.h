/* deformed.h - a lattice that gets its displacements from another one of the same size. */
#ifndef FFD_AUTHOR_DEFORMED_H
#define FFD_AUTHOR_DEFORMED_H

#include <ffd/lattice.h>

/* Makes a lattice with the rest of `lattice` and the deformed control points of `from`, or if `from` moves
   nothing, its control points; and its deformed weights, if it has any. Where both have one rest, to the bit,
   the displacements are those of `from`, to the bit. The caller destroys *result. Their sizes are
   equal. Errors: FFD_E_INVALID where one has no positions yet (ffd_lattice_fit); FFD_E_MEMORY. */
ffd_status ffd_lattice_take_deformed(const ffd_lattice *lattice, const ffd_lattice *from,
                                     ffd_lattice **result, ffd_error *error);
/* The same with the displacements of `from`; if its file has none, its control points are displacements. */
ffd_status ffd_lattice_take_offsets(const ffd_lattice *lattice, const ffd_lattice *from, ffd_lattice **result,
                                    ffd_error *error);

#endif
