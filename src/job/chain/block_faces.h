/* block_faces.h - blocks (lattices side by side): whether two of them move a point of their common face
   alike. */
#ifndef FFD_JOB_CHAIN_BLOCK_FACES_H
#define FFD_JOB_CHAIN_BLOCK_FACES_H

#include "job/chain/chain.h"

/* A point's parameters in a block. */
typedef struct block_place {
    const chain_link *link;
    const double *uvw;
} block_place;

/* Sets *parting to the difference of the displacements by two blocks at a point. It is 0 if they agree to
   rounding, or if the next block has no points beyond those faces of the own block that the point reaches
   with its rounding cell (half: half its extents) and the snap. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_blocks_part(const block_place *own, const block_place *next, const double half[3], double snap,
                           double *parting, ffd_error *error);

#endif
