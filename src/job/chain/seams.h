/* seams.h - seams of a chain: pairs of rest faces of one lattice that coincide, as of a full turn that is not
   closed, and that the moves separate. */
#ifndef FFD_JOB_CHAIN_SEAMS_H
#define FFD_JOB_CHAIN_SEAMS_H

#include "job/chain/chain.h"

/* Finds the seams of a chain. All lattices must be fitted. Errors: FFD_E_MEMORY. */
ffd_status ffd_seams_find(lattice_chain *chain, ffd_error *error);

/* Returns the number of marks a point can have. One after the other: one for each link, then one for each
   seam. Blocks: one for points that are in no block, one for points on a face that another block moves
   differently, and, if any block has a seam, three more, one for each direction. */
size_t ffd_chain_marked(const lattice_chain *chain);

/* Returns the seam of link l in this direction, or NULL. */
const chain_seam *ffd_chain_seam(const lattice_chain *chain, size_t l, int direction);

/* Marks a point of the run, at uvw in link l, for each seam of the link if it is nearer to the last face than
   to the first. An edge across the seam then has one marked end. */
void ffd_seams_mark(const lattice_chain *chain, size_t l, chain_run *run, size_t point, const double uvw[3]);

/* Returns the distance between the displacements of the two faces of a seam, at `low` on the first face and
   at `high` on the last one; their parameter along the seam's direction is ignored. 0 if it is within
   rounding. */
double ffd_seam_parting(const lattice_chain *chain, const chain_seam *seam, const double low[3],
                        const double high[3]);

#endif
