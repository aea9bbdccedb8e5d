/* rig_places.h - the places of a document (joints, pivots, sockets and so on), and how a job's lattices move
   them. */
#ifndef FFD_JOB_RIG_RIG_PLACES_H
#define FFD_JOB_RIG_RIG_PLACES_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

typedef struct rig_places {
    mesh_places places;
    mesh_place_move *moves; /* one a place */
} rig_places;

/* Lists the places (all: as in mesh_format.list_places) and sends them through the fitted chain like
   vertices; became: filled with the new place of each. Leaves none if the format has no places. Call
   ffd_rig_places_free also after a failure. Errors: FFD_E_MEMORY, and those of finding u,v,w. */
ffd_status ffd_rig_places_find(const mesh_document *document, const lattice_chain *chain, bool all,
                               rig_places *rig, ffd_error *error);

/* Frees the arrays; leaves none. */
void ffd_rig_places_free(rig_places *rig);

#endif
