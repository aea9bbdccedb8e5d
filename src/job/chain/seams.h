/* seams.h - the seams of a chain: pairs of rest faces that are one surface, as of a full turn that is not
 * closed, and that the moves take apart. */
#ifndef FFD_JOB_CHAIN_SEAMS_H
#define FFD_JOB_CHAIN_SEAMS_H

#include "job/chain/chain.h"

/* Finds the seams of a chain whose lattices are fitted. Errors: FFD_E_MEMORY. */
ffd_status ffd_seams_find(lattice_chain *chain, ffd_error *error);

/* How many links marks are about. One after the other: each, and one more for each seam. Of blocks two: one
   that stands for all of them, which leaves what is in none, and one that leaves points on a face that
   another block moves otherwise; and three more, one for each direction, where some block has a seam. */
size_t ffd_chain_marked(const lattice_chain *chain);

/* The seam of link l in this direction; NULL: there is none. */
const chain_seam *ffd_chain_seam(const lattice_chain *chain, size_t l, int direction);

/* Marks a point of the run which has these u,v,w in link l, for each seam of the link if it is nearer to the
   last face than to the first. An edge across the seam has one end of either kind. */
void ffd_seams_mark(const lattice_chain *chain, size_t l, chain_run *run, size_t point, const double uvw[3]);

/* How far the faces of a seam part: between the first face at the u,v,w `low` and the last one at `high`,
   whose coordinates of the seam's direction do not matter. 0 where that may be rounding. */
double ffd_seam_parting(const lattice_chain *chain, const chain_seam *seam, const double low[3],
                        const double high[3]);

#endif
