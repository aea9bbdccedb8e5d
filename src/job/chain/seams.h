/* seams.h - where the displacement by one lattice may jump: at seams, pairs of rest faces that coincide, as
   of a full turn that is not closed, and that the moves separate; at axes that the moves open. */
#ifndef FFD_JOB_CHAIN_SEAMS_H
#define FFD_JOB_CHAIN_SEAMS_H

#include "job/chain/chain.h"

/* Finds the seams and axes of a chain, which volumes are boxes, and which move nothing. All lattices must be
   fitted. Errors: FFD_E_MEMORY. */
ffd_status ffd_seams_find(lattice_chain *chain, ffd_error *error);

/* Returns whether two neighbouring points of link l, at a and b, are on different sides of a seam. */
bool ffd_seams_part(const lattice_chain *chain, size_t l, const double a[3], const double b[3]);

#endif
