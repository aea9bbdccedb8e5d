/* embedding.h - the embedding of points: their u,v,w in the rest volume of a lattice, each with a status. */
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

/* What is known about the solutions of C(u,v,w) = p for a point p. The values are those of `ffd embed
   --status`. */
typedef enum ffd_vertex_status {
    FFD_VERTEX_INSIDE = 0,   /* exactly one solution */
    FFD_VERTEX_OUTSIDE = 1,  /* none within the tolerance; this is proven */
    FFD_VERTEX_MULTIPLE = 2, /* two or more: the lattice overlaps itself */
    FFD_VERTEX_SINGULAR = 3, /* a solution where det J is 0 to rounding, or a set of solutions, or the search
                         stopped without a result: u,v,w is then where it stopped */
    FFD_VERTEX_INVALID = 4   /* a coordinate of p is not finite */
} ffd_vertex_status;

#define FFD_VERTEX_STATUS_COUNT 5

/* Returns "inside", "outside", "multiple", "singular" or "invalid"; NULL for another value. The string is
   static. Thread-safe. */
FFD_API const char *ffd_vertex_status_name(ffd_vertex_status status);

/* What happens to a point outside of the lattice: KEEP leaves it as it is, to the bit; EXTEND gives it the
   displacement of the nearest border point, which may fade with the distance (src/maths.md 8.2); ERROR fails
   with FFD_E_EMBEDDING. */
typedef enum ffd_outside { FFD_OUTSIDE_KEEP = 0, FFD_OUTSIDE_EXTEND, FFD_OUTSIDE_ERROR } ffd_outside;

/* The search structure for the rest volume of one lattice. Searches do not change it. */
typedef struct ffd_locator ffd_locator;

typedef struct ffd_location {
    double uvw[3];   /* in the range of the knots; NaN: no solution */
    double residual; /* |C(u,v,w) - p|, Euclidean, world units; 0 without u,v,w */
    uint8_t status;  /* ffd_vertex_status */
    bool unresolved; /* the search stopped at one of its limits: there may be solutions that it did not find.
                        Always false with FFD_VERTEX_INSIDE and FFD_VERTEX_OUTSIDE. */
    uint32_t evaluations; /* of C with its Jacobian; 0 for affine and separable lattices */
    uint32_t leaves;      /* leaves of the search structure that were searched */
} ffd_location;

/* Prepares the inversion of the rest volume of lattice. The lattice must stay unchanged as long as the
   locator is used. The method depends on the control points (src/maths.md 5 and 6): closed form for an affine
   volume; for a separable one Newton's method with bracketing in each direction; otherwise a search over span
   cells with a contraction bound (Krawczyk's operator on the Bernstein form). Thread-safe. Errors:
   FFD_E_ARGUMENT (the lattice has no control points yet), FFD_E_INVALID (a cell without volume),
   FFD_E_MEMORY, FFD_E_LIMIT. */
FFD_API ffd_status ffd_locator_create(const ffd_lattice *lattice, ffd_locator **locator, ffd_error *error);

/* Destroys the locator and sets *locator to NULL. locator and *locator may be NULL. */
FFD_API void ffd_locator_destroy(ffd_locator **locator);

/* Returns the method: "affine", "separable" or "general". The string is static. Thread-safe. */
FFD_API const char *ffd_locator_get_method(const ffd_locator *locator);

/* How far a point may be outside of the volume and still count as inside, at the nearest point of the
   border. */
typedef struct ffd_border_allowance {
    size_t struct_size;     /* sizeof(ffd_border_allowance) in the caller's header */
    const double *rounding; /* 3*count doubles, >= 0, world units: the allowance in each coordinate of each
                               point, for instance half an ulp of the number in the file, transformed to world
                               space. NULL: 0. */
    double snap;            /* Euclidean distance, world units, >= 0 */
} ffd_border_allowance;

/* Finds u,v,w for count points.
     xyz           3*count doubles, world units
     allowance     may be NULL (none)
     locations     count results; location_size is sizeof(ffd_location) in the caller's header, because the
                   elements have no struct_size of their own
   The result of a point depends only on the point and the lattice, to the bit. For a point with status
   FFD_VERTEX_INSIDE, the residual in each coordinate a is at most 16 eps (max|P_a| + |p_a|) plus the change
   of C_a by rounding u,v,w.

   With an allowance, a point that would be outside is inside if a point of the border is within the tolerance
   plus rounding of it in each coordinate, or within the distance snap. u,v,w and residual are then those of
   the nearest border point. If the search of the border stops before this is decided, the point is
   FFD_VERTEX_SINGULAR and unresolved, without u,v,w. All other results are the same as without an allowance,
   to the bit. A rounding of at most 1/16 of the tolerance is ignored, since the tolerance includes it.

   Thread-safe; allocates only memory that it frees before it returns. Errors: FFD_E_ARGUMENT (sizes),
   FFD_E_MEMORY, FFD_E_LIMIT; some locations are then undefined. */
FFD_API ffd_status ffd_locator_locate(const ffd_locator *locator, const double *xyz, size_t count,
                                      const ffd_border_allowance *allowance, ffd_location *locations,
                                      size_t location_size, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
