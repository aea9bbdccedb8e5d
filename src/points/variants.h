/* variants.h - many variants of the control points of an embedding's lattice, and the control points of one.
 */
#ifndef FFD_POINTS_VARIANTS_H
#define FFD_POINTS_VARIANTS_H

#include "deform/variant_kernel.h"
#include "points/embedding.h"

/* The greatest magnitude of numbers with which nothing that is computed of them can overflow: displacements
   are multiplied with binomial coefficients, of which no three have a product above 2^36. */
#define VARIANT_MOST 0x1p960

typedef struct variant_set {
    ffd_variants of; /* the caller's */
    const ffd_embedding *embedding;
    const ffd_lattice *rest;
    size_t step[3]; /* control points from one to the next along u, v, w in the values of a variant */
    size_t *places; /* owned: the tables that follow */
    /* For each span of a direction that is not empty, and each function of it: the numbers before those of
       its control point, among the values and among the points at rest. */
    size_t *at[3], *rest_at[3];
    bool is_rational; /* weights of control points matter */
    bool is_large;    /* a point at rest is beyond VARIANT_MOST */
} variant_set;

/* Checks what a caller wants. To be ended in every case. Errors: FFD_E_ARGUMENT, FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_variants_begin(const ffd_embedding *embedding, const ffd_variants *wanted, variant_set *made,
                              ffd_error *error);
/* Frees the tables. */
void ffd_variants_end(variant_set *made);

/* Returns the values of a variant. */
static inline const double *ffd_variant_values(const variant_set *all, size_t variant)
{
    return all->of.values + 3 * all->rest->count * variant;
}

/* Returns what is to be subtracted from the values of each variant, in their order; NULL: nothing. *room is
   to be freed in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_variants_origin(const variant_set *all, const double **origin, double **room,
                               ffd_error *error);
/* Copies the displacements of the control points of the cell with these indices of spans, u fastest, as
   ffd_lattice_cell_points, and may write one number more. */
void ffd_variant_cell(const variant_set *all, size_t variant, const size_t index[3], double *numbers);
/* Sets up the same cell where its values are, if all degrees are 3. */
bool ffd_variant_source(const variant_set *all, size_t variant, const size_t index[3],
                        variant_source *source);
/* Makes the lattice that a variant is, with all checks of its control points. The caller destroys *made.
   Errors: those of setting them; FFD_E_MEMORY. */
ffd_status ffd_variant_lattice(const variant_set *all, size_t variant, ffd_lattice **made, ffd_error *error);

#endif
