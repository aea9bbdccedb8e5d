/* collapse.h - faces and edges of the domain that the lattice collapses, such as the axis of a cylinder or a
   pole. Each of their points has a whole line of u,v,w. They are detected once, and points on them get a
   result without a search (src/maths.md 6.5). */
#ifndef FFD_EMBED_CELLS_COLLAPSE_H
#define FFD_EMBED_CELLS_COLLAPSE_H

#include "embed/cells/cells.h"

/* Detects the collapsed faces and edges. The points, scale and extent of locator->cells must be set. */
ffd_status ffd_collapses_find(const ffd_locator *locator, collapse_list *list, ffd_error *error);
/* Frees the list and empties it. */
void ffd_collapses_free(collapse_list *list);

/* Returns whether x (in the search's units) is on the set within the tolerance, and sets uvw to the least
   u,v,w there. */
bool ffd_collapse_holds(const ffd_locator *locator, const collapse *set, const double x[3],
                        const double tolerance[3], double uvw[3]);

#endif
