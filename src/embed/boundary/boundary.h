/* boundary.h - the nearest point of the rest volume's border, whose displacement `--outside extend` gives to
   a point without u,v,w. */
#ifndef FFD_EMBED_BOUNDARY_BOUNDARY_H
#define FFD_EMBED_BOUNDARY_BOUNDARY_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include <stdbool.h>

/* The faces of the domain (two a direction that is not closed), cut into patches and sorted into a tree. Made
   once for a rest lattice, not changed by a search, shared by threads. */
typedef struct boundary boundary;

typedef struct boundary_point {
    bool found; /* false: the border is farther than reach, or there is none; all but cut_short is 0 then */
    double uvw[3];       /* in the knots' range, on a face of the domain */
    double distance;     /* |p - C(u,v,w)|, world units; infinite where that is too large for a double */
    double direction[3]; /* (p - C) / distance; 0 where the distance is 0 */
    double uvw_by_p[9];  /* row by row: how u,v,w follows p, first order; rows of coordinates that rest on a
                            face, an edge, a corner or a ridge (a knot where the face has a kink) are 0, and
                            all where it is not defined: at a centre of curvature */
    bool cut_short;      /* the search ended at its limit: there may be a nearer point within reach */
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

   For a box, clips the coordinates of p. Otherwise this is branch and bound over Bezier patches of the faces.
   A patch is dropped when its control points, or an interval bound of the distance's derivatives, show that
   it holds nothing nearer (by 1e-12 of the lattice) than what is known. A search ends with the nearest point
   found after 4096 patches (cut_short); only very many points equally near take that many. If p is more than
   2^400 lattices away, a nearer point in the same direction is used instead.

   Thread-safe; memory is allocated for the time of the call. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_find(const boundary *border, const double p[3], double reach, boundary_point *nearest,
                             ffd_error *error);

/* What is known of the border and a box of places. */
typedef enum boundary_verdict {
    BOUNDARY_MISSES,   /* they have nothing in common, which is proven */
    BOUNDARY_MEETS,    /* they have a point in common, or are nearer than a millionth of the box */
    BOUNDARY_UNDECIDED /* the search ended at its limit, 4096 patches and parts of patches */
} boundary_verdict;

/* Whether the border meets the box of places that are no farther than each > 0 from p along x, y and z. The
   sides may be of very different lengths: the search measures by them. Thread-safe, as above. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_boundary_meets(const boundary *border, const double p[3], const double each[3],
                              boundary_verdict *verdict, ffd_error *error);

#endif
