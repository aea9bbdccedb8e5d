/* locator.h - the search structure for one rest lattice (public: ffd/embedding.h). */
#ifndef FFD_EMBED_LOCATOR_H
#define FFD_EMBED_LOCATOR_H

#include "base/vector/isa.h"
#include <ffd/embedding.h>

/* ffd_locator_create with the instructions of the kernels; they change no bit. */
ffd_status ffd_locator_create_for(const ffd_lattice *lattice, ffd_isa isa, ffd_locator **locator,
                                  ffd_error *error);

/* ffd_locator_locate without an allowance, for locations of this library's own size. */
ffd_status ffd_locator_find(const ffd_locator *locator, const double *xyz, size_t count,
                            ffd_location *locations, ffd_error *error);

/* The same with an allowance, or NULL. */
ffd_status ffd_locator_find_near(const ffd_locator *locator, const double *xyz, size_t count,
                                 const ffd_border_allowance *allowance, ffd_location *locations,
                                 ffd_error *error);

/* Whether the two rest faces of this direction coincide (ffd_lattice_is_seam). */
bool ffd_locator_has_seam(const ffd_locator *locator, int direction);

/* Whether points so far used up a part of the memory budget (FFD_E_LIMIT): then less is left for others. */
bool ffd_locator_is_strained(const ffd_locator *locator);

#endif
