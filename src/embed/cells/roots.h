/* roots.h - the u,v,w that were found for one point: joined where they are one, ranked by the tie rule. */
#ifndef FFD_EMBED_CELLS_ROOTS_H
#define FFD_EMBED_CELLS_ROOTS_H

#include "embed/cells/cells.h"

/* Roots of one point that are kept apart; of more, the best by the tie rule are kept. */
#define MOST_ROOTS 16

typedef struct root {
    double uvw[3];   /* in the locator's knots */
    double residual; /* |C - x|, in the search's units */
    double determinant;
    double spread[3]; /* how far roots that are one may lie apart, by direction */
    bool singular;
} root;

typedef struct root_list {
    int count;
    root roots[MOST_ROOTS];
} root_list;

/* Adds a root, or joins it to one that is the same: both within 1e-9 of the domain or their spreads, also
   across the seam of a closed direction or of two faces that are one. */
void ffd_roots_add(const ffd_locator *locator, root_list *list, const root *found);

/* Whether a root of the list is the same. */
bool ffd_roots_hold(const ffd_locator *locator, const root_list *list, const root *found);

/* The tie rule: the root with the sign of the lattice's volume, then the least (u,v,w). The
   list must not be empty. */
const root *ffd_roots_best(const ffd_locator *locator, const root_list *list);

#endif
