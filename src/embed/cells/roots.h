/* roots.h - the list of roots that were found for a point: equal ones are joined, and the tie rule ranks
   them. */
#ifndef FFD_EMBED_CELLS_ROOTS_H
#define FFD_EMBED_CELLS_ROOTS_H

#include "embed/cells/cells.h"

/* The most roots of a point; of more, the best by the tie rule are kept. */
#define MOST_ROOTS 16

typedef struct root {
    double uvw[3];   /* in the locator's knots */
    double residual; /* |C - x|, in the search's units */
    double determinant;
    bool singular;
    /* For each direction, the distance within which roots are equal: 4 width |J^-1| times the tolerance.
       Nearly always a root has no other beside it, and it is not needed. */
    double spread[3];
    bool has_spread; /* it is known; else made from these: */
    double jacobian[9], width[3], tolerance[3];
} root;

typedef struct root_list {
    int count;
    root roots[MOST_ROOTS];
} root_list;

/* Finds the spread of a root, if it is not known. */
void ffd_root_find_spread(root *of);

/* Adds a root, or joins it with an equal one: one within 1e-9 of the domain or within the spreads, also
   across the seam of a closed direction or of two coinciding faces. */
void ffd_roots_add(const ffd_locator *locator, root_list *list, const root *found);

/* Joins root `other` of the list with root `kept`, which has a lower index: they are known to be one. */
void ffd_roots_unite(const ffd_locator *locator, root_list *list, int kept, int other);

/* Returns whether the list has an equal root. The spread of `found` must be known. */
bool ffd_roots_hold(const ffd_locator *locator, root_list *list, const root *found);

/* Returns the best root by the tie rule: det J with the sign of the lattice's volume, then the least (u,v,w).
   The list must not be empty. */
const root *ffd_roots_best(const ffd_locator *locator, const root_list *list);

#endif
