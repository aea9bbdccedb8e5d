/* gram.h - integrals of products of basis functions and of their derivatives, and the bending of a lattice
   that is made of them: the energy of a thin plate (Wahba, Spline Models for Observational Data, 1990, 2.4).
 */
#ifndef FFD_FIT_GRAM_H
#define FFD_FIT_GRAM_H

#include "fit/band.h"
#include "fit/unknowns.h"

/* Of one direction: the integral over the domain, scaled to a length, of N_i^(q) N_j^(q). Of control point i
   and the function of offset o from it: values[q][(2 degree + 1) i + degree + o]. In a closed direction
   several offsets may lead to one control point, whose integral is their sum. */
typedef struct gram_matrix {
    const knot_vector *knots;
    double *values[3];
} gram_matrix;

/* The bending of a lattice. */
typedef struct fit_bending {
    const fit_unknowns *unknowns;
    gram_matrix grams[3];
    double trace;   /* of its matrix */
    bool stretches; /* some direction is of degree 1, which does not bend: first derivatives count instead */
} fit_bending;

/* Finds the mean length of a lattice's lines of control points along each direction, at rest; closed ones
   return to their first point. Of a box its sides. */
void ffd_bending_lengths(const ffd_lattice *lattice, double lengths[3]);

/* Makes the bending of a lattice of these lengths, by exact quadrature. Free with ffd_bending_free, in every
   case. Errors: FFD_E_MEMORY. */
ffd_status ffd_bending_make(const fit_unknowns *unknowns, const double lengths[3], fit_bending *bending,
                            ffd_error *error);
/* Frees its arrays and empties it. */
void ffd_bending_free(fit_bending *bending);

/* Adds factor times its matrix to a band matrix. */
void ffd_bending_add(const fit_bending *bending, double factor, const band_matrix *band);
/* to += factor * (its matrix) x, for 3 numbers of each unknown. */
void ffd_bending_apply(const fit_bending *bending, double factor, const double *x, double *to);

#endif
