/* boundary.h - the nearest point of the rest volume's border: where `--outside extend` takes the displacement
   of a point from that has no u,v,w. */
#ifndef FFD_EMBED_BOUNDARY_H
#define FFD_EMBED_BOUNDARY_H

#include "base/fail.h"
#include "lattice/lattice.h"
#include <stdbool.h>

/* The faces of the domain (two a direction that is not closed), cut into patches and sorted into a tree. Made
   once for a rest lattice, not changed by a search, shared by threads. */
typedef struct boundary boundary;

typedef struct boundary_point {
    bool found;          /* false: the border is farther than reach, or there is none */
    double uvw[3];       /* in the knots' range, on a face of the domain */
    double distance;     /* |p - C(u,v,w)| */
    double direction[3]; /* (p - C) / distance; 0 where the distance is 0 */
    double uvw_by_p[9];  /* row by row: how u,v,w follows p, first order; rows of coordinates that rest on a
                            face, edge or corner are 0, and all where it is not defined */
} boundary_point;

/* lattice must outlive the boundary unchanged. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_create(const ffd_lattice *lattice, boundary **made, ffd_error *error);
void ffd_boundary_destroy(boundary **made); /* NULL and pointers to NULL are allowed */

/* The point of the border nearest to p (world units), if it is no farther than reach (HUGE_VAL: any). Of
   points equally near to rounding the least (u,v,w). Depends on p, reach and the lattice only, to the bit; a
   smaller reach changes nothing but found. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_find(const boundary *border, const double p[3], double reach, boundary_point *nearest,
                             ffd_error *error);

#endif
