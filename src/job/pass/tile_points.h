/* tile_points.h - the way of a tile's points, the same for the base and for a morph target: into the
   lattice's space, through the chain, and back to the file's space. */
#ifndef FFD_JOB_PASS_TILE_POINTS_H
#define FFD_JOB_PASS_TILE_POINTS_H

#include "job/pass/tile.h"

/* Prepares for the points of a tile. offsets: of all its vertices in a morph target (shape), or NULL. */
void ffd_tile_points_begin(const pass_tile *tile, const double *offsets, size_t shape, tile_points *points);

/* Puts point i, which is vertex v of the tile, to where it is at rest. */
void ffd_tile_place(tile_points *points, size_t i, size_t v);

/* The same, and lets it stay there. */
void ffd_tile_hold(tile_points *points, size_t i, size_t v);

/* Returns a run of the points through the chain. gradients: whether they are wanted. */
chain_run ffd_tile_run(tile_points *points, bool gradients);

/* Adds the times of a run to the totals. */
void ffd_tile_add_times(const pass_tile *tile, const chain_run *run);

/* If the part's node or skin moves too (the rig follows), adjusts the displacements so that vertices end up
   where the deformation puts them in the scene. Vertices that are not finite stay. */
void ffd_tile_carry(tile_points *points, bool gradients);

/* Transforms the displacements to the file's space: p' = p + linear^{-1} delta. */
void ffd_tile_bring_back(tile_points *points);
/* Transforms the gradients to the file's space. */
void ffd_tile_bring_gradients_back(tile_points *points);

/* Widens the box by the points that count for bounds. Returns whether all points are finite. */
bool ffd_tile_widen(const tile_points *points, ffd_bounds *box);

#endif
