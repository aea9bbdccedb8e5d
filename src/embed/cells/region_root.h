/* region_root.h - a root in a region: the evaluation there, the residual that is allowed, and the record of
   what was found. */
#ifndef FFD_EMBED_CELLS_REGION_ROOT_H
#define FFD_EMBED_CELLS_REGION_ROOT_H

#include "embed/cells/point_search.h"

/* Evaluates C - x, F and the derivatives of F by t, at t in a region. */
void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at);

/* Computes bounds of the residual of a root at t: the tolerance of the point, plus the change of C by
   rounding u,v,w. */
void ffd_search_allowance(const point_search *search, const cell_region *region, const double t[3],
                          const sample *at, double allowance[3]);
/* Returns whether t is a root to the aim of the search. Weights can make C so steep that the rounding of
   u,v,w alone exceeds the aim; with weights it is allowed too. */
bool ffd_search_accepts(const point_search *search, const cell_region *region, const double t[3],
                        const sample *at);
/* Returns whether t is a root to rounding: the tolerance and the rounding of u,v,w explain the residual. With
   weights a share of both is left for the rounding of C itself. */
bool ffd_search_admits(const point_search *search, const cell_region *region, const double t[3],
                       const sample *at);
/* The same with a smaller share left, for a t at which the residual is nearly the least. */
bool ffd_search_meets(const point_search *search, const cell_region *region, const double t[3],
                      const sample *at);

/* Records the root at t, whose sample is `at`. */
void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular);
/* Describes an iteration that stalls at t, whose sample is `at`, with neither a root nor a proof that there
   is none. */
void ffd_search_stall(point_search *search, const cell_region *region, const double t[3], const sample *at,
                      root *stall);

#endif
