/* splat.h - Gaussian splats under a deformation gradient F = I + gradient (src/maths.md 9.6): the turn of
   what is seen from a direction, and the ellipsoid. */
#ifndef FFD_SPLAT_SPLAT_H
#define FFD_SPLAT_SPLAT_H

#include "base/vector/isa.h"
#include "splat/splat_types.h"
#include <stddef.h>
#include <stdint.h>

/* Finds the orthogonal factors of the polar decompositions of F, of `count` gradients of nine numbers. Where
   F is the identity, or is not of numbers, the turn is the identity. The bits are the same whatever the
   instruction set. */
void ffd_splats_find_turns(ffd_isa isa, const double *gradients, size_t count, splat_turn *turns);

/* Turns a turn into that of a space from which `frame` (invertible) leads to the gradient's. */
void ffd_splat_turn_to_file(const double frame[9], splat_turn *turn);

/* The covariances become F covariance F^T. Of the axes that one can have those are taken that are nearest to
   the turned old ones; the quaternion keeps its length. outcomes: a splat_outcome of each. The bits are the
   same whatever the instruction set. */
void ffd_splats_deform(ffd_isa isa, const double *gradients, const splat_turn *turns, const splat_form *form,
                       size_t count, splat_ellipsoid *splats, uint8_t *outcomes);

/* The matrix of a quaternion of length 1. */
void ffd_splat_matrix(const double quaternion[4], double matrix[9]);

#endif
