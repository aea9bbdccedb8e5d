/* rig_figures.h - how far joints, pivots and sockets lag behind the deformed mesh. */
#ifndef FFD_JOB_RIG_RIG_FIGURES_H
#define FFD_JOB_RIG_RIG_FIGURES_H

#include "job/rig/rig_places.h"

/* Returns the distance of a place in the output from where a vertex there would be moved; 0 if it is
   rounding. diagonal: of the scene. */
double ffd_rig_lag(const mesh_place_move *move, double diagonal);

/* Fills the figures from the places and the outcome of --rig follow. Errors: FFD_E_MEMORY. */
ffd_status ffd_rig_figures_find(const mesh_document *document, const rig_places *rig,
                                const mesh_following *following, double diagonal, ffd_rig_result *figures,
                                ffd_error *error);

/* Warns of lagging places. follows: the job used --rig follow, so any lag is left over. */
void ffd_rig_warn(const ffd_rig_result *figures, bool follows, double diagonal, const mesh_log *log);

/* Returns the diagonal of a box; 0 if it is empty. */
double ffd_rig_diagonal(const ffd_bounds *box);

#endif
