/* leaf.h - finds the only root of a region. */
#ifndef FFD_EMBED_CELLS_LEAF_H
#define FFD_EMBED_CELLS_LEAF_H

#include "embed/cells/point_search.h"

/* Evaluates C - x, F and the derivatives of F by t, at t in a region. */
void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at);

/* Records the root at t, whose sample is `at`. */
void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular);
/* Describes an iteration that stalls at t, whose sample is `at`, with neither a root nor a proof that there
   is none. */
void ffd_search_stall(point_search *search, const cell_region *region, const double t[3], const sample *at,
                      root *stall);
/* Returns whether t is a root to rounding: the residual is at most the tolerance plus the change of C by
   rounding u,v,w. */
bool ffd_search_admits(const point_search *search, const cell_region *region, const double t[3],
                       const sample *at);
/* Finds the root of a region, or proves that it has none. Returns false if the iteration stalls without
   either; *stall says where. */
bool ffd_search_region(point_search *search, const cell_region *region, root *stall);

#endif
