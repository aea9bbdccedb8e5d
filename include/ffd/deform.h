/* deform.h - the displacement of single embedded points, and of normals and tangents at them. points.h has
   the same for arrays, with threads and SIMD. */
#ifndef FFD_DEFORM_H
#define FFD_DEFORM_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/lattice.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Evaluates the displacement at one u,v,w, which is clamped to the domain (closed directions: taken modulo
   the period).
     delta[3]    sum (Q_ijk - P_ijk) R_ijk(u,v,w), in world units; if weights are moved, C_Q - C_P.
     gradient[9] gradient[3*r+c] = d delta_r / d p_c, that is (d delta / d uvw) J_P^-1; the deformation
                 gradient is F = I + gradient. 0 where J_P is not invertible. May be NULL.
   Returns 1 if u,v,w is in the support of a moved control point. Otherwise returns 0 and sets delta and
   gradient to 0: the point keeps its bits. P and Q are the control points at rest and deformed; basis
   functions: Piegl & Tiller, The NURBS Book, A2.1 to A2.3, rational: 4.4; src/maths.md 7.1 and 7.2. The
   lattice must have control points (ffd_lattice_fit). Thread-safe. */
FFD_API int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                             double gradient[9]);

/* What becomes of a normal or a tangent. Except for FFD_DIRECTION_CARRIED it keeps its bits. */
typedef enum ffd_direction_outcome {
    FFD_DIRECTION_KEPT = 0,  /* the gradient is 0, or the direction is 0 or not finite */
    FFD_DIRECTION_CARRIED,   /* it is transformed */
    FFD_DIRECTION_COLLAPSED, /* its image is 0 to rounding: the surface collapses */
    FFD_DIRECTION_OUTCOMES   /* the number of outcomes */
} ffd_direction_outcome;

/* Transforms a normal to the deformed surface: result = cof(F) n / |cof(F) n| with F = I + gradient
   (src/maths.md 9.1). gradient: 9 doubles, as ffd_displacement fills them. n need not have unit length.
   result may be n itself. Thread-safe. */
FFD_API ffd_direction_outcome ffd_deform_normal(const double gradient[9], const double normal[3],
                                                double result[3]);

/* Transforms a tangent to the deformed surface: F t, minus its component along normal, normalised. normal:
   the deformed unit normal, or NULL to keep that component. result may be t itself. Thread-safe. */
FFD_API ffd_direction_outcome ffd_deform_tangent(const double gradient[9], const double tangent[3],
                                                 const double normal[3], double result[3]);

#ifdef __cplusplus
}
#endif

#endif
