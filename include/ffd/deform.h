/* deform.h - the displacement that a deformed lattice gives to embedded points. */
#ifndef FFD_DEFORM_H
#define FFD_DEFORM_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/lattice.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The displacement at one u,v,w (in the domain).
     delta[3]    sum (Q - P) R(u,v,w), world units; with moved weights C_Q - C_P.
     gradient[9] row by row, gradient[3*r+c] = d delta_r / d p_c = (d delta / d uvw) J_P^{-1}; the deformation
                 gradient F is I + gradient. May be NULL. 0 where J_P has no inverse.
   Returns 1 when u,v,w is in the support of a moved control point, else 0 (delta and gradient are then exact
   zeros: the point keeps its bits). Thread-safe. The lattice must not need bounds. */
FFD_API int ffd_displacement(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                             double gradient[9]);

/* Carries a normal n to the deformed surface: cof(I + gradient) n, normalised. Returns 1 and writes
   result; returns 0 and copies n where gradient is all 0 or n is zero or not finite (the bits are kept),
   or where the result has no direction (collapse): *collapsed is then 1, else 0. collapsed may be NULL;
   result may be n. Thread-safe. */
FFD_API int ffd_deform_normal(const double gradient[9], const double normal[3], double result[3],
                              int *collapsed);

/* Carries a tangent t: F t, made perpendicular to the deformed normal and normalised. Returned and kept as
   for ffd_deform_normal. normal is the deformed unit normal, or NULL (no orthogonalisation). */
FFD_API int ffd_deform_tangent(const double gradient[9], const double tangent[3], const double normal[3],
                               double result[3], int *collapsed);

#ifdef __cplusplus
}
#endif

#endif
