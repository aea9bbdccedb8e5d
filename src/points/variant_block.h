/* variant_block.h - displaces some of the points by a block of variants: as many as a register has lanes, or
   a single one. For lattices without weights. */
#ifndef FFD_POINTS_VARIANT_BLOCK_H
#define FFD_POINTS_VARIANT_BLOCK_H

#include "base/vector/array_kernel.h"
#include "deform/displacement.h"
#include "deform/variant_kernel.h"
#include "points/point_cells.h"
#include "points/variants.h"

/* Points that are displaced at a time. */
#define VARIANT_POINTS ((size_t)256)

typedef struct block_work {
    const variant_set *variants;
    const point_cells *cells;
    const double *origin; /* as of ffd_variants_origin */
    ffd_span in, out;
    const double *in_doubles; /* in, if it is doubles without gaps */
    double *out_doubles;      /* out, likewise */
    float *out_floats;        /* out, if it is floats without gaps */
    double largest;           /* that the type of out holds */
    const variant_kernel *kernel;
    const cell_kernels *single; /* for a single variant */
    const array_kernel *arrays;
} block_work;

/* Scratch memory of a thread. */
typedef struct block_scratch {
    size_t packed; /* 1 + the first variant of the block that is in `field`; 0: none */
    bool fits;     /* whether these can be computed with (VARIANT_MOST) */
    double *room;  /* owned: all that follows */
    double *field;
    variant_planes planes;
    double *vectors, *x, *weight;
    double *numbers, *bezier; /* of the control points of a cell, in a single variant */
    uint32_t *order;          /* 0, 1, 2 .. */
    uint8_t *changed;
} block_scratch;

/* Variants, and a range of the sorted points. */
typedef struct block_part {
    size_t variant, count; /* count: at most as many as the kernel has lanes */
    bool is_single;        /* without lanes; count is 1 */
    size_t first, end;
} block_part;

/* Allocates the scratch memory of a thread; lanes: it is for blocks, too. */
bool ffd_block_scratch_make(const block_work *work, bool lanes, block_scratch *scratch);
/* Frees it. */
void ffd_block_scratch_free(block_scratch *scratch);
/* Returns the bytes of that memory for the control points. */
double ffd_block_scratch_size(const block_work *work);

/* Reads the variants of a part, if they are not those that were read last. Returns whether they can be
   computed with. */
bool ffd_block_take(const block_work *work, const block_part *part, block_scratch *scratch);
/* Writes the points of a part. Returns false if one is too large for the type of the result. */
bool ffd_block_deform(const block_work *work, const block_part *part, block_scratch *scratch);

#endif
