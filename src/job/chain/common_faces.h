/* common_faces.h - points on a face of a lattice, and those on a face that two lattices of a chain share,
   which both move. */
#ifndef FFD_JOB_CHAIN_COMMON_FACES_H
#define FFD_JOB_CHAIN_COMMON_FACES_H

#include "job/chain/chain.h"

/* How far a place in a link may be off. */
double ffd_link_rounding(const chain_link *link);
/* How near to a face, in parts of the domain, a run's points may be that reach it, given the largest cell of
   these (chain_scratch). */
double ffd_faces_near(const chain_link *link, double snap, const chain_run *run);
/* Returns which faces of a link, as ffd_faces_at has them, a point with these u,v,w is on, or reaches with
   half the cell that it stands for, the snap and the rounding of the place. jacobian: filled with that of the
   rest volume there. */
unsigned ffd_faces_reached(const chain_link *link, const double uvw[3], const double half[3], double snap,
                           double jacobian[9]);
/* The outward unit normals of these faces; zeros for the other ones. */
void ffd_faces_normals(unsigned faces, const double jacobian[9], double normals[6][3]);

/* Whether a run through this chain looks for such points: not where each lattice moves what is outside too.
 */
static inline bool ffd_common_wanted(const lattice_chain *chain)
{
    return chain->boxes && !chain->blocks && !chain->outside.extend;
}

/* Forgets the points of an earlier run, and finds the largest cell of this one's. */
void ffd_common_begin(chain_run *run);
/* Notes those of the points, which the run's locations are of, that are on a face of the link. Before they
   are moved. */
void ffd_common_note(const lattice_chain *chain, size_t link, const chain_run *run);
/* After the link has moved the points by these displacements: drops those that it noted and does not move,
   and counts in the run those that a link before noted, which are on the same face of this link and which it
   moves. */
ffd_status ffd_common_count(const lattice_chain *chain, size_t link, const double *deltas, chain_run *run,
                            ffd_error *error);

#endif
