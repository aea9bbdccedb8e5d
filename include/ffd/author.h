/* author.h - lattices made from lattices. Each call leaves its arguments as they are. */
#ifndef FFD_AUTHOR_H
#define FFD_AUTHOR_H

#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* The following make a lattice with the same control points at rest, or the same ones placed elsewhere, and
   other displacements: moves become offsets. Where control points or their weights would not be finite, or
   weights not positive, they fail with FFD_E_INVALID; so they do for a box round a mesh without one
   (ffd_lattice_fit) that has moves, weights or deformed points. The caller destroys *result, which is NULL
   after a failure. Thread-safe. Other errors: FFD_E_ARGUMENT (a number that is not finite), FFD_E_MEMORY. */

/* Multiplies all displacements D by strength: 0.5 is half the deformation, 1 the same to the bit, -1 the
   opposite. Weights q that moved from h become (1 - strength) h + strength q. */
FFD_API ffd_status ffd_lattice_strength(const ffd_lattice *lattice, double strength, ffd_lattice **result,
                                        ffd_error *error);
/* Makes (1 - t) of what a lattice does and t of what other does: D = (1 - t) D + t D_other, and so the moved
   weights. t may be outside of 0 to 1; at both it is one of them to the bit. FFD_E_INVALID also where they
   differ, to the bit, in size, degree, knots, rest or weights at rest. */
FFD_API ffd_status ffd_lattice_blend(const ffd_lattice *lattice, const ffd_lattice *other, double t,
                                     ffd_lattice **result, ffd_error *error);
/* Makes what both do: D = D + D_other, and so the changes of weights. FFD_E_INVALID as of
   ffd_lattice_blend. */
FFD_API ffd_status ffd_lattice_add(const ffd_lattice *lattice, const ffd_lattice *other, ffd_lattice **result,
                                   ffd_error *error);
/* Makes the mirror image along direction 0 to 2 (u, v, w): what a control point does, reflected, is done by
   the one opposite. The plane stands between the middles of the first and the last layer. Twice it is the
   same, to the bit if the plane is perpendicular to a coordinate axis. FFD_E_INVALID also where the lattice
   at rest is not symmetric to the plane: a control point to 1e-9 of the diagonal, a weight to 1e-12 of the
   largest, a knot to 1e-12 of their range; or where the direction is closed. */
FFD_API ffd_status ffd_lattice_mirror(const ffd_lattice *lattice, int direction, ffd_lattice **result,
                                      ffd_error *error);
/* Makes one half the mirror image of the other: that of the last layers stays if keep_last is true, else that
   of the first. In a layer between them displacements off the plane become 0. Errors: as of
   ffd_lattice_mirror. */
FFD_API ffd_status ffd_lattice_symmetrize(const ffd_lattice *lattice, int direction, bool keep_last,
                                          ffd_lattice **result, ffd_error *error);
/* Places the lattice elsewhere by an affine map M, given row by row (the last row 0 0 0 1), with the same
   deformation there: P becomes M P, and D its linear part times D. A box stays one if its sides stay at right
   angles (to 1e-15), other shapes become control points. FFD_E_INVALID also if the determinant is 0. */
FFD_API ffd_status ffd_lattice_transform(const ffd_lattice *lattice, const double matrix[16],
                                         ffd_lattice **result, ffd_error *error);

/* For ffd_lattice_seal: the faces of all directions that are not closed. */
#define FFD_FACES_ALL 64u

/* Holds faces still, so that what is deformed joins what is not with continuity C^k: on these faces the
   displacement and its derivatives up to the k-th are 0 (for Bezier volumes: Sederberg and Parry, Free-form
   deformation of solid geometric models, 1986). The directions of the faces are clamped first
   (ffd_lattice_refine), then the displacements of the k + 1 outermost layers at each become 0, and their
   weights those at rest. faces: bit 2 a + side, with a 0 to 2 for u, v, w and side 0 for the first layers, 1
   for the last, or FFD_FACES_ALL. FFD_E_ARGUMENT for no faces, a face of a closed direction, or a k that is
   not 0 to degree - 1 of the directions of the faces. */
FFD_API ffd_status ffd_lattice_seal(const ffd_lattice *lattice, int k, unsigned faces, ffd_lattice **result,
                                    ffd_error *error);

/* Makes the inverse: the deformed volume becomes the one at rest, of control points, and the volume at rest
   the deformed one; weights change places. It is exact, and holds for places in the image of the volume.
   threads: as of ffd_folds_find. FFD_E_INVALID also where that does not prove that the lattice has no folds.
 */
FFD_API ffd_status ffd_lattice_invert(const ffd_lattice *lattice, int threads, ffd_lattice **result,
                                      ffd_error *error);

/* Adds noise to all displacements: sigma[a] x, with x in [-1, 1) for axis a of each control point, as of the
   move "jitter": SplitMix64, the same bits on every machine. sigma: world units, from 0 on; seed: at most
   2^53 - 1. FFD_E_ARGUMENT where they are not. */
FFD_API ffd_status ffd_lattice_jitter(const ffd_lattice *lattice, const double sigma[3], uint64_t seed,
                                      ffd_lattice **result, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
