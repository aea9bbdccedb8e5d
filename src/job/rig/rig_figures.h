/* rig_figures.h - how far joints, pivots and sockets are from where the lattices move the mesh. */
#ifndef FFD_JOB_RIG_RIG_FIGURES_H
#define FFD_JOB_RIG_RIG_FIGURES_H

#include "job/rig/rig_places.h"

/* How far a place is, in the output, from where vertices in it would be moved. What is only rounding counts
   as nothing: diagonal is that of the scene. */
double ffd_rig_lag(const mesh_place_move *move, double diagonal);

/* Fills the figures from the places and what follow has done. Errors: FFD_E_MEMORY. */
ffd_status ffd_rig_figures_find(const mesh_document *document, const rig_places *rig,
                                const mesh_following *following, double diagonal, ffd_rig_result *figures,
                                ffd_error *error);

/* Warns of what lags. follows: what should have gone along has. */
void ffd_rig_warn(const ffd_rig_result *figures, bool follows, double diagonal, const mesh_log *log);

/* The diagonal of a box; 0 where there is nothing in it. */
double ffd_rig_diagonal(const ffd_bounds *box);

#endif
