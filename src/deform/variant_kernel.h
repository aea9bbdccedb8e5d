/* variant_kernel.h - the kernel that displaces points by many variants of the control points at once: a lane
   holds one variant. variant_table.c selects one. */
#ifndef FFD_DEFORM_VARIANT_KERNEL_H
#define FFD_DEFORM_VARIANT_KERNEL_H

#include "base/vector/isa.h"
#include "deform/kernel.h"
#include "lattice/lattice.h"
#include <stdbool.h>

/* Numbers of several variants: to each number of a single one belongs a register, with a lane for each
   variant. A vector x,y,z is three registers. */
typedef double variant_numbers;

/* A cell of a lattice without weights. */
typedef struct variant_cell {
    int degree[3];
    const double *extraction[3]; /* weighted (spline/bezier.h) */
    double first[3], width[3];   /* first knot and length of the span */
    const size_t *at[3]; /* control point i,j,k has number at[0][i] + at[1][j] + at[2][k] and the next two */
    const variant_numbers *field; /* displacements: a vector for each control point */
    size_t column;                /* cells of one column, which differ along w only, have one number */
    size_t first_plane;           /* number of the first function along w */
} variant_cell;

/* A cell of a single variant, of degree 3, where the values are that a caller gives. */
typedef struct variant_source {
    const double *extraction[3];
    const double
        *values; /* a vector for each control point, that of i,j,k from at[0][i] + at[1][j] + at[2][k] on */
    const size_t *at[3];
    const double *rest; /* NULL, or what is subtracted, likewise */
    const size_t *rest_at[3];
    size_t last; /* where the last vector is, in both, after which nothing may be read */
} variant_source;

/* What is known of a column: its planes of control points, in Bezier form along u and v. Neighbouring cells
   of a column share all but one. */
typedef struct variant_planes {
    size_t column;            /* SIZE_MAX: none */
    size_t number[MAX_ORDER]; /* 1 + the number of the plane in each place; 0: none */
    variant_numbers *vectors; /* a place for each plane of a cell, of (d_u + 1)(d_v + 1) vectors */
    variant_numbers *bezier;  /* the points of the cell, as those of a kernel_field: as many places */
} variant_planes;

/* Points that were displaced, and where they are to be. */
typedef struct variant_moves {
    const double *x;             /* 3 numbers for each point */
    const double *fade, *weight; /* NULL, or factors for each point */
    size_t count;
    double largest;           /* that the numbers may have */
    variant_numbers *vectors; /* for each point: the displacements, replaced by the moved points */
} variant_moves;

typedef struct variant_kernel {
    size_t lanes;
    /* Lays numbers of variants side by side: from[l] has those of lane l, count each, from which `minus` is
       subtracted if it is not NULL. Returns whether no number in `from` is NaN or greater than `most` in
       magnitude. */
    bool (*pack)(const double *const *from, const double *minus, size_t count, double most, double *to);
    /* Returns whether none of count numbers is NaN or greater than `most` in magnitude. */
    bool (*fits)(const double *numbers, size_t count, double most);
    /* Computes the Bezier points of a cell (extraction_kernel), with the planes that are there already. */
    void (*extract)(const variant_cell *cell, variant_planes *planes);
    /* Computes the displacements of one point, without those. */
    void (*displace_one)(const variant_cell *cell, variant_planes *planes, const double uvw[3],
                         variant_numbers *vector);
    /* Computes the displacements of count points of the cell, as displacement_kernel does for one variant.
       uvw: 3 numbers for each. */
    void (*displace)(const variant_cell *cell, const variant_numbers *bezier, const double *uvw, size_t count,
                     variant_numbers *vectors);
    /* As extraction_kernel for a single variant; writes one number after the points. */
    void (*extract_cubic)(const variant_source *source, double *points);
    /* As displacement_kernel for a single variant, without derivatives and for points 0 to count - 1: a lane
       holds a coordinate, so that few points are quicker. Reads one number after those of the field. */
    void (*displace_few)(const kernel_cell *cell, const double *uvw, size_t count, double *delta);
    /* Multiplies displacements with their factors, and adds them to the points; a coordinate to which 0 is
       added keeps its bits. Returns whether no coordinate that changes is NaN or too large. */
    bool (*move)(const variant_moves *moves);
} variant_kernel;

extern const variant_kernel ffd_variant_kernel_scalar;
#define DECLARE(ISA, set, lanes) extern const variant_kernel ffd_variant_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

/* Returns the kernel of an instruction set; FFD_ISA_AUTO: of the best available one. */
const variant_kernel *ffd_variant_kernel(ffd_isa isa);

#endif
