/* common_faces.h - finds points on a face of a lattice, and points on a common face of two consecutive
   lattices that both move. */
#ifndef FFD_JOB_CHAIN_COMMON_FACES_H
#define FFD_JOB_CHAIN_COMMON_FACES_H

#include "job/chain/chain.h"

/* Returns the error bound of a place evaluated in a link, world units. */
double ffd_link_rounding(const chain_link *link);
/* Returns the distance from a face, relative to the domain, within which points of a run may reach the face
   with their rounding cells (chain_scratch.cell) and the snap. */
double ffd_faces_near(const chain_link *link, double snap, const chain_run *run);
/* Returns the faces of a link (bits as in ffd_faces_at) that a point at uvw reaches with its rounding cell
   (half: half its extents), the snap and the evaluation error. jacobian: filled with that of the rest
   volume. */
unsigned ffd_faces_reached(const chain_link *link, const double uvw[3], const double half[3], double snap,
                           double jacobian[9]);
/* Fills the outward unit normals of these faces, with zeros for the others. */
void ffd_faces_normals(unsigned faces, const double jacobian[9], double normals[6][3]);

/* Whether runs through this chain look for such points. They need not if each lattice also moves points
   outside of it. */
static inline bool ffd_common_wanted(const lattice_chain *chain)
{
    return chain->boxes && !chain->blocks && !chain->outside.extend;
}

/* Clears the places of the last run, and finds the largest rounding cell of this one. */
void ffd_common_begin(chain_run *run);
/* Records the points on a face of the link, by the run's locations. Call it before the link moves them. */
void ffd_common_note(const lattice_chain *chain, size_t link, const chain_run *run);
/* Call it after the link has moved the points by these displacements. Drops the recorded points that the link
   does not move. Counts the points recorded by earlier links that are on the same face of this link, and that
   it moves (chain_run.moved_twice). */
ffd_status ffd_common_count(const lattice_chain *chain, size_t link, const double *deltas, chain_run *run,
                            ffd_error *error);

#endif
