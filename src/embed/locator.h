/* locator.h - the search structure for a rest lattice (public functions: ffd/embedding.h). */
#ifndef FFD_EMBED_LOCATOR_H
#define FFD_EMBED_LOCATOR_H

#include "base/vector/isa.h"
#include "base/vector/vec.h"
#include <ffd/embedding.h>
#include <stdbool.h>

/* As ffd_locator_create, with the instruction set of the kernels, which does not affect results. */
ffd_status ffd_locator_create_for(const ffd_lattice *lattice, ffd_isa isa, ffd_locator **locator,
                                  ffd_error *error);

/* As ffd_locator_locate, without an allowance, for locations of the library's own size. */
ffd_status ffd_locator_find(const ffd_locator *locator, const double *xyz, size_t count,
                            ffd_location *locations, ffd_error *error);

/* Finds u,v,w, 3 numbers each, of those points that are plainly inside a volume whose rest map is affine:
   found is 1 for these and 0 for all others, which ffd_locator_find finds. Returns count, or 0 for another
   volume. */
size_t ffd_locator_find_inside(const ffd_locator *locator, const double *xyz, size_t count, double *uvw,
                               uint8_t *found);

/* The same as ffd_locator_find with an allowance, which may be NULL. */
ffd_status ffd_locator_find_near(const ffd_locator *locator, const double *xyz, size_t count,
                                 const ffd_border_allowance *allowance, ffd_location *locations,
                                 ffd_error *error);

/* Returns whether a box of points is inside the volume, with room to spare; false says nothing. A cheap
   answer for many points of a volume that is a box itself. */
bool ffd_locator_holds_box(const ffd_locator *locator, const double min[3], const double max[3]);

/* Whether the location has u,v,w. */
static inline bool ffd_location_is_placed(const ffd_location *location)
{
    return location->status != FFD_VERTEX_OUTSIDE && location->status != FFD_VERTEX_INVALID &&
           vec_is_finite(location->uvw);
}

/* Returns whether the two rest faces of a direction coincide (ffd_lattice_is_seam). */
bool ffd_locator_has_seam(const ffd_locator *locator, int direction);

/* Returns whether the searches so far used up a part of the memory budget (FFD_E_LIMIT), so that less is left
   for further points. */
bool ffd_locator_is_strained(const ffd_locator *locator);

#endif
