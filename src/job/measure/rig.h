/* rig.h - the places of a document (joints, pivots, sockets and so on): how a job's lattices move them, and
   how far they lag behind the deformed mesh. */
#ifndef FFD_JOB_MEASURE_RIG_H
#define FFD_JOB_MEASURE_RIG_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"
#include "mesh/places.h"

typedef struct rig_places {
    mesh_places places;
    mesh_place_move *moves; /* one a place */
} rig_places;

/* Lists the places (all: as in mesh_place_calls.list) and sends them through the fitted chain like
   vertices; became: filled with the new place of each. Leaves none if the format has no places. Call
   ffd_rig_places_free also after a failure. Errors: FFD_E_MEMORY, and those of finding u,v,w. */
ffd_status ffd_rig_places_find(const mesh_document *document, const lattice_chain *chain, bool all,
                               rig_places *rig, ffd_error *error);

/* Frees the arrays; leaves none. */
void ffd_rig_places_free(rig_places *rig);

/* Returns the distance of a place in the output from where a vertex there would be moved; 0 if it is
   rounding. diagonal: of the scene. */
double ffd_rig_lag(const mesh_place_move *move, double diagonal);

/* Fills the figures from the places and the outcome of --rig follow. kinds: a set of PLACE_BIT, of the places
   that count. Errors: FFD_E_MEMORY. */
ffd_status ffd_rig_figures_find(const mesh_document *document, const rig_places *rig,
                                const mesh_following *following, unsigned kinds, double diagonal,
                                ffd_rig_figures *figures, ffd_error *error);

/* The kinds of places that figures and warnings are about; those of a job that makes a morph target. */
#define RIG_KINDS (PLACE_BIT(FFD_BEHIND_JOINT) | PLACE_BIT(FFD_BEHIND_PIVOT) | PLACE_BIT(FFD_BEHIND_SOCKET))
#define RIG_KINDS_OF_MORPHS PLACE_BIT(FFD_BEHIND_JOINT)

/* What the lag of a place is left from. */
typedef enum rig_change { RIG_KEPT, RIG_FOLLOWED, RIG_MORPHED } rig_change;

/* Warns of lagging places, unless they are what --rig follow could not move. */
void ffd_rig_warn(const ffd_rig_figures *figures, rig_change change, double diagonal, const mesh_log *log);

/* Returns the diagonal of a box; 0 if it is empty. */
double ffd_rig_diagonal(const ffd_bounds *box);

#endif
