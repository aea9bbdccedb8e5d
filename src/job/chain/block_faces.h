/* block_faces.h - lattices side by side: whether two of them move a point of their common face alike. */
#ifndef FFD_JOB_CHAIN_BLOCK_FACES_H
#define FFD_JOB_CHAIN_BLOCK_FACES_H

#include "job/chain/chain.h"

/* A point in a block. */
typedef struct block_place {
    const chain_link *link;
    const double *uvw;
} block_place;

/* How far the displacements by two blocks part, to *parting: 0 where they are one to rounding, or where the
   second block has nothing beyond the faces of the own one that the point is on or reaches, with half the
   cell that it stands for and the snap. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_blocks_part(const block_place *own, const block_place *next, const double half[3], double snap,
                           double *parting, ffd_error *error);

#endif
