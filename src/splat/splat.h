/* splat.h - Gaussian splats under a deformation gradient F = I + gradient (src/maths.md 9.6): the rotation of
   view-dependent colours, and the ellipsoid. The covariances by which splats are drawn are in covariance.c.
 */
#ifndef FFD_SPLAT_SPLAT_H
#define FFD_SPLAT_SPLAT_H

#include "base/vector/isa.h"
#include "splat/splat_types.h"
#include <stddef.h>
#include <stdint.h>

/* Computes the orthogonal factors of the polar decompositions of F, for count gradients of nine numbers. If F
   is the identity or not finite, the result is the identity. The bits are the same for all instruction
   sets. */
void ffd_splats_find_turns(ffd_isa isa, const double *gradients, size_t count, splat_turn *turns);

/* Converts a rotation to another space. frame: the invertible map from that space to the space of the
   gradient. */
void ffd_splat_turn_to_file(const double frame[9], splat_turn *turn);

/* Replaces the covariances by F covariance F^T. Of the equivalent axes, those nearest to the rotated old ones
   are taken; the quaternion keeps its length. outcomes: a splat_outcome for each splat. The bits are the same
   for all instruction sets. */
void ffd_splats_deform(ffd_isa isa, const double *gradients, const splat_turn *turns, const splat_form *form,
                       size_t count, splat_ellipsoid *splats, uint8_t *outcomes);

/* Computes the covariance R S S R^T of an ellipsoid: xx, xy, xz, yy, yz, zz. Not finite where the ellipsoid
 * is not. */
void ffd_splat_covariance(const splat_ellipsoid *splat, const splat_form *form, double covariance[6]);
/* Replaces a covariance C by M C M^T. */
void ffd_covariance_carry(const double matrix[9], double covariance[6]);

/* Computes the matrix of a unit quaternion. */
void ffd_splat_matrix(const double quaternion[4], double matrix[9]);

#endif
