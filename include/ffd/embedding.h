/* embedding.h - u,v,w of points: the inverse of a lattice's rest volume, with a verdict for each point. */
#ifndef FFD_EMBEDDING_H
#define FFD_EMBEDDING_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of a point p and the equation C(u,v,w) = p. The numbers are those of `ffd embed --status`. */
typedef enum ffd_vertex_status {
    FFD_INSIDE = 0,       /* exactly one u,v,w */
    FFD_OUTSIDE = 1,      /* proven: none within the tolerance */
    FFD_MULTIPLE = 2,     /* two or more: the lattice overlaps itself */
    FFD_SINGULAR = 3,     /* u,v,w where det J = 0 to rounding, or a set of them; or the search gave up:
                             then where it stood still */
    FFD_POINT_INVALID = 4 /* a coordinate is not finite */
} ffd_vertex_status;

#define FFD_VERTEX_STATUS_COUNT 5

/* A point outside of a lattice stays, to the bit; moves as the continuation of the nearest border point's
   displacement says; is a failure. */
typedef enum ffd_outside { FFD_OUTSIDE_KEEP = 0, FFD_OUTSIDE_EXTEND, FFD_OUTSIDE_ERROR } ffd_outside;

/* The search structure for one rest lattice: made once, never changed by a search, shared freely by threads.
 */
typedef struct ffd_locator ffd_locator;

typedef struct ffd_location {
    double uvw[3];   /* in the knots' range; NaN where there is none */
    double residual; /* |C(u,v,w) - p|, world units (Euclidean); 0 where there is no u,v,w */
    uint8_t status;  /* ffd_vertex_status */
    bool unresolved; /* the search stood still, or its limits ended it: there may be u,v,w that it did not
                        come to. Never with FFD_INSIDE or FFD_OUTSIDE. */
    uint32_t evaluations; /* of C with its Jacobian; 0 for an affine or separable lattice's closed forms */
    uint32_t leaves;      /* leaves of the search structure that were looked into */
} ffd_location;

/* Prepares the inversion of lattice's rest volume, which must outlive the locator unchanged. The way is
   chosen by the control points: affine in closed form, separable by bracketed one-dimensional Newton
   steps, else a search over cells with a contraction bound (Krawczyk's operator on the Bernstein form).
   Errors: FFD_E_ARGUMENT (the lattice still needs bounds), FFD_E_INVALID (a cell without volume),
   FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_locator_create(const ffd_lattice *lattice, ffd_locator **locator, ffd_error *error);

/* Frees the locator and clears the pointer. NULL and pointers to NULL are allowed. */
FFD_API void ffd_locator_destroy(ffd_locator **locator);

/* Which way is used: "affine", "separable" or "general". A constant string. */
FFD_API const char *ffd_locator_get_method(const ffd_locator *locator);

/* By how much points may miss the volume and still be inside, at the nearest point of its border. */
typedef struct ffd_border_allowance {
    size_t struct_size;     /* sizeof(ffd_border_allowance) of the caller */
    const double *rounding; /* 3*count doubles >= 0, world units: in each coordinate, such as half an ulp of
                               the number in the file, carried to the world. NULL: none. */
    double snap;            /* a Euclidean distance, world units; 0: none */
} ffd_border_allowance;

/* Finds u,v,w for count points (xyz: 3*count doubles, world units); fills count locations, of which the
   caller knows location_size bytes each (sizeof(ffd_location)): they have no size of their own, for there are
   many. A result depends on its point and the lattice only, to the bit. No point is called inside with a
   residual, in any coordinate a, above 16 eps (max|P_a| + |p_a|) and what the rounding of u,v,w moves C_a by.

   allowance: NULL, or for points that are known up to it. One that would be outside without is inside when a
   point of the border misses it by no more than its tolerance and its rounding in each coordinate, or is no
   farther than snap: u,v,w and residual are then those of the border's nearest point. It is singular and
   unresolved, without u,v,w, when the search of the border ended before it was shown that there is none.
   Nothing else changes, to the bit. Rounding up to 1/16 of the tolerance counts as part of it.

   Thread-safe; no allocation outlives the call. Errors: FFD_E_ARGUMENT (sizes), FFD_E_MEMORY, FFD_E_LIMIT
   (locations are then not all filled). */
FFD_API ffd_status ffd_locator_locate(const ffd_locator *locator, const double *xyz, size_t count,
                                      const ffd_border_allowance *allowance, ffd_location *locations,
                                      size_t location_size, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
