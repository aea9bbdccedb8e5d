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

/* Transforms a normal to the deformed surface: result = cof(F) n / |cof(F) n| with F = I + gradient
   (src/maths.md 9.1). gradient: 9 doubles, as ffd_displacement fills them. n need not have unit length.
   Returns 1 if result is the transformed normal. Otherwise returns 0 and copies n to result, bit for bit:
   because gradient is 0, because n is 0 or not finite, or because cof(F) n is 0 to rounding (the surface
   collapses). *collapsed is set to 1 in the last case, to 0 in all others; collapsed may be NULL. result may
   be n itself. Thread-safe. */
FFD_API int ffd_deform_normal(const double gradient[9], const double normal[3], double result[3],
                              int *collapsed);

/* Transforms a tangent to the deformed surface: F t, minus its component along normal, normalised. normal:
   the deformed unit normal, or NULL to keep that component. Return value, collapsed and result: as for
   ffd_deform_normal. Thread-safe. */
FFD_API int ffd_deform_tangent(const double gradient[9], const double tangent[3], const double normal[3],
                               double result[3], int *collapsed);

#ifdef __cplusplus
}
#endif

#endif
