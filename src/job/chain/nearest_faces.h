/* nearest_faces.h - the faces of lattices that a point outside is beyond. */
#ifndef FFD_JOB_CHAIN_NEAREST_FACES_H
#define FFD_JOB_CHAIN_NEAREST_FACES_H

#include "job/chain/chain.h"

/* Receives faces of a link: bit 2 a + side, as of ffd_lattice_seal. */
typedef void nearest_face_visitor(void *context, size_t link, unsigned faces);

/* Finds the faces on which the border point of a link is that is nearest to p, which is outside; of blocks,
   of all that are equally near. Of faces that meet at that point those count that p is beyond, not those in
   whose plane it is, nor those behind which there is another block, or, after a full turn, the volume itself.
   Thread-safe, as visit must be. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_nearest_faces(const lattice_chain *chain, size_t link, const double p[3],
                             nearest_face_visitor *visit, void *context, ffd_error *error);

#endif
