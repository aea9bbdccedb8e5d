/* rig_places.h - what a document places beside vertices, and what the lattices of a job do there. */
#ifndef FFD_JOB_RIG_RIG_PLACES_H
#define FFD_JOB_RIG_RIG_PLACES_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

typedef struct rig_places {
    mesh_places places;
    mesh_place_move *moves; /* one a place */
} rig_places;

/* Lists the places (all: as mesh_format's list_places says) and sends them through the chain, which is
   fitted, as vertices are sent; became is where each is. None where the format has none. To be freed also
   after a failure. Errors: FFD_E_MEMORY, and those of finding u,v,w. */
ffd_status ffd_rig_places_find(const mesh_document *document, const lattice_chain *chain, bool all,
                               rig_places *rig, ffd_error *error);

/* Leaves none. */
void ffd_rig_places_free(rig_places *rig);

#endif
