/* author.h - lattices made from lattices. Each call leaves its arguments as they are. */
#ifndef FFD_AUTHOR_H
#define FFD_AUTHOR_H

#include <ffd/lattice.h>

#ifdef __cplusplus
extern "C" {
#endif

/* More control points, or higher degrees, for the same map. Fill with ffd_refine_desc_init, then change
   members. The order is that of the members. */
typedef struct ffd_refine_desc {
    size_t struct_size; /* sizeof(ffd_refine_desc) in the caller's header */
    int degree[3];      /* not less than now, at most FFD_MAX_DEGREE; 0 (default): as it is */
    /* insert_count knots to insert along u, v, w, in any order, in the range of the lattice's knots; closed:
       modulo the period. One that is there, or is given more than once, becomes a knot of so many more: at
       most degree times inside the domain, degree + 1 times at its ends. */
    const double *insert[3];
    size_t insert_count[3];
    /* As many control points, by halving the longest spans, the first ones first; not less than there are by
       then; 0 (default): as they are. */
    size_t size[3];
} ffd_refine_desc;

/* Sets desc to defaults. size: sizeof(ffd_refine_desc) in the caller's header. */
FFD_API void ffd_refine_desc_init(ffd_refine_desc *desc, size_t size);

/* Makes a lattice with more control points or of higher degree that is the same map, at rest and deformed:
   each coordinate of C differs by at most 4 eps (d_u + d_v + d_w) times the largest coordinate of a control
   point (times the ratio of the weights, if it has weights), eps = 2^-52. A direction that is neither clamped
   nor closed is clamped first where its degree rises. Moves become offsets. Control points whose neighbours
   did not move do not move, to the bit, and those among whose knots none is inserted keep their bits. A box
   stays one, unless the lattice has weights or its control points are not at the Greville abscissae; other
   shapes become control points. By blossoms: Piegl and Tiller, The NURBS Book, 2nd ed., 5.2 and 5.5. The
   caller destroys *refined. Thread-safe. Errors: FFD_E_ARGUMENT for a wish that cannot be met, or nothing
   that would change; FFD_E_INVALID for a box round a mesh without one (ffd_lattice_fit) where positions are
   needed: it has moves, weights or control points; FFD_E_LIMIT above 2^26 control points; FFD_E_MEMORY. */
FFD_API ffd_status ffd_lattice_refine(const ffd_lattice *lattice, const ffd_refine_desc *desc,
                                      ffd_lattice **refined, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
