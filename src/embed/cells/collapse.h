/* collapse.h - faces and edges of the domain that the lattice collapses: a cylinder's axis, a pole. Their
   points have whole lines of u,v,w; they are found once and answered directly (src/maths.md 6.5). */
#ifndef FFD_EMBED_CELLS_COLLAPSE_H
#define FFD_EMBED_CELLS_COLLAPSE_H

#include "embed/cells/cells.h"

/* Looks at the borders of the locator's lattice; its cells' points, scale and extent must be there. */
ffd_status ffd_collapses_find(const ffd_locator *locator, collapse_list *list, ffd_error *error);
/* Frees the list; it is empty then. */
void ffd_collapses_free(collapse_list *list);

/* Whether x (in the search's units) lies on the set within the tolerance: then the least u,v,w there. */
bool ffd_collapse_holds(const ffd_locator *locator, const collapse *set, const double x[3],
                        const double tolerance[3], double uvw[3]);

#endif
