/* boundary.h - the nearest point of the border of the rest volume, whose displacement `--outside extend`
   gives to a point without u,v,w. */
#ifndef FFD_EMBED_BOUNDARY_BOUNDARY_H
#define FFD_EMBED_BOUNDARY_BOUNDARY_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include <stdbool.h>

/* The faces of the domain (two for each direction that is not closed), divided into patches in a tree. Built
   once for a rest lattice and immutable, so threads can share it. */
typedef struct boundary boundary;

typedef struct boundary_point {
    bool found;    /* false: the border is farther away than reach, or there is none; all other members except
                      cut_short are then 0 */
    double uvw[3]; /* in the range of the knots, on a face of the domain */
    double distance;     /* |p - C(u,v,w)|, world units; infinite if that overflows */
    double direction[3]; /* (p - C) / distance; 0 if the distance is 0 */
    double uvw_by_p[9];  /* row-major derivative of u,v,w by p. Rows of coordinates that are fixed on a face,
                            an edge, a corner or a ridge (a knot at which the face has a kink) are 0; all rows
                            are 0 if it is not defined, at a centre of curvature */
    bool cut_short;      /* the search stopped at its limit: there may be a nearer point within reach */
} boundary_point;

/* Builds the boundary of a lattice, which must have control points and stay unchanged as long as the boundary
   is used. Memory: less than 250 MB for any lattice. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_create(const ffd_lattice *lattice, boundary **made, ffd_error *error);
/* Destroys the boundary and sets *made to NULL. made and *made may be NULL. */
void ffd_boundary_destroy(boundary **made);

/* Finds the border point nearest to p (world units; p may be inside the volume), if its distance is at most
   reach (>= 0; HUGE_VAL: no limit). Of points that are equally near to rounding it is the one with the least
   (u,v,w); coordinates within 1e-9 of the domain count as equal. The result depends only on p and the
   lattice, to the bit; reach affects only found. Nothing is found for a p that is not finite.

   For a box, the coordinates of p are clamped. Otherwise the search is branch and bound over Bezier patches
   of the faces. A patch is dropped when its control points, or interval bounds of the derivatives of the
   distance, prove that it has no point that is nearer (by 1e-12 of the lattice) than the best known one. The
   search stops after 4096 patches with the nearest point found so far (cut_short); only a very large number
   of equally near points takes that long. If p is more than 2^400 lattice sizes away, a nearer point in the
   same direction is used instead.

   Thread-safe; allocates memory during the call. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_find(const boundary *border, const double p[3], double reach, boundary_point *nearest,
                             ffd_error *error);

/* Whether the border meets a box of positions. */
typedef enum boundary_verdict {
    BOUNDARY_MISSES,   /* proven: they have no point in common */
    BOUNDARY_MEETS,    /* they have a point in common, or their distance is less than a millionth of the
                          box */
    BOUNDARY_UNDECIDED /* the search stopped at its limit of 4096 patches and parts of patches */
} boundary_verdict;

/* Decides whether the border meets the box with centre p and half sides each (> 0) along x, y, z. The sides
   may have very different lengths, because the search scales by them. Thread-safe; allocates memory during
   the call. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_meets(const boundary *border, const double p[3], const double each[3],
                              boundary_verdict *verdict, ffd_error *error);

#endif
