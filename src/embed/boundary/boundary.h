/* boundary.h - the nearest point of the rest volume's border: where `--outside extend` takes the displacement
   of a point from that has no u,v,w. */
#ifndef FFD_EMBED_BOUNDARY_BOUNDARY_H
#define FFD_EMBED_BOUNDARY_BOUNDARY_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include <stdbool.h>

/* The faces of the domain (two a direction that is not closed), cut into patches and sorted into a tree. Made
   once for a rest lattice, not changed by a search, shared by threads. */
typedef struct boundary boundary;

typedef struct boundary_point {
    bool found;          /* false: the border is farther than reach, or there is none; all else is 0 then */
    double uvw[3];       /* in the knots' range, on a face of the domain */
    double distance;     /* |p - C(u,v,w)|, world units; infinite where that is too large for a double */
    double direction[3]; /* (p - C) / distance; 0 where the distance is 0 */
    double uvw_by_p[9];  /* row by row: how u,v,w follows p, first order; rows of coordinates that rest on a
                            face, an edge, a corner or a ridge (a knot where the face has a kink) are 0, and
                            all where it is not defined: at a centre of curvature */
} boundary_point;

/* lattice must have control points and outlive the boundary unchanged. Memory: less than 250 MB,
   whatever the lattice. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_create(const ffd_lattice *lattice, boundary **made, ffd_error *error);
/* Frees the boundary and clears the pointer; NULL and pointers to NULL are allowed. */
void ffd_boundary_destroy(boundary **made);

/* The point of the border nearest to p (world units; also from within the volume), if it is no farther than
   reach (>= 0; HUGE_VAL: any). Of points equally near to rounding the least (u,v,w), where coordinates within
   1e-9 of the domain are equal. Depends on p and the lattice only, to the bit; reach changes nothing but
   found. No point is found for a p that is not finite.

   Boxes: their coordinates, clipped. Else branch and bound over Bezier patches of the faces, each left when
   its control points, or an interval bound of the distance's derivatives, show that it holds nothing nearer
   (by 1e-12 of the lattice) than what is known; a search that has looked into 4096 patches, which takes very
   many points equally near, ends with the nearest found. Where p is more than 2^400 lattices away a nearer
   point in the same direction is used instead.

   Any thread; memory is taken for the time of the call. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_find(const boundary *border, const double p[3], double reach, boundary_point *nearest,
                             ffd_error *error);

#endif
