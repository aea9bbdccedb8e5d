/* displacement.h - the displacement of many points at once, and by the lattice's own parameters (public:
   ffd/deform.h). Declares displacement.c and displacement_batch.c. */
#ifndef FFD_DEFORM_DISPLACEMENT_H
#define FFD_DEFORM_DISPLACEMENT_H

#include "base/vector/isa.h"
#include "deform/displacement_cell.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <stdint.h>

/* The displacement at u,v,w as ffd_displacement gives it, and by_uvw[3*r+c] = d delta_r / d uvw_c: right-hand
   at an inner knot, left-hand at the end of the domain. Returns as ffd_displacement. */
int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9]);

/* Most points of a batch. So many that where a lattice is fine the rows of a mesh that cross the same cells
   meet, and yet fit the cache nearest but one with all that is known of them. */
#define DISPLACEMENT_BATCH ((size_t)4096)

/* A cell of a batch, and which of its points lie in it. */
typedef struct batch_cell {
    size_t span[3]; /* numbers of its non-empty spans */
    size_t key;     /* its number in the lattice */
    uint32_t first, count;
} batch_cell;

/* Wanted points one after the other that lie in the same cell. */
typedef struct batch_stretch {
    uint32_t first; /* of the wanted points */
    uint32_t cell;  /* of the batch */
} batch_stretch;

/* Numbers of cells (displacement_cell.h) that batches had before: neighbours in a mesh
   often come back to them. */
#define KEPT_CELLS ((size_t)1024)
#define KEPT_NUMBERS (KEPT_CELLS * (3 * 4 * 4 * 4 + 1))

/* What the threads of a pass may keep in all, 3 MB: a machine can have many. */
#define KEPT_IN_ALL (2 * KEPT_NUMBERS)

typedef struct kept_cells {
    int threads;                 /* that share the memory; set by whoever made the scratch, 0 as 1 */
    const ffd_lattice *lattice;  /* whose cells they are; NULL: there are none */
    cell_use use;                /* of them */
    size_t count, numbers;       /* capacity in cells, and the numbers that each has */
    size_t keys[KEPT_CELLS];     /* 1 + key of a batch_cell; 0: none */
    uint16_t places[KEPT_CELLS]; /* of its numbers: one after the other as they come, so that few pages are
                                    touched */
    uint16_t used;               /* places that are taken */
    cell_motion motions[KEPT_CELLS];
    double all_numbers[KEPT_NUMBERS];
} kept_cells;

/* What a batch needs beside its results; of one thread. */
typedef struct displacement_scratch {
    kept_cells kept;
    double jacobian[9 * DISPLACEMENT_BATCH];
    batch_cell cells[DISPLACEMENT_BATCH];
    size_t cell_count;
    batch_stretch stretches[DISPLACEMENT_BATCH + 1]; /* the last one only ends the one before */
    size_t stretch_count;
    uint16_t buckets[2 * DISPLACEMENT_BATCH]; /* cells by their keys */
    uint32_t sorted[DISPLACEMENT_BATCH];      /* the wanted points' numbers, cell by cell */
    double uvw[3 * DISPLACEMENT_BATCH];       /* and their u,v,w */
} displacement_scratch;

typedef struct displacement_batch {
    const double *uvw; /* of point n from uvw[n * stride] on, in the domain */
    size_t stride;
    const uint32_t *which; /* the numbers n, below DISPLACEMENT_BATCH, of the points that are wanted, each
                              greater than the one before */
    size_t count;
    double *delta;    /* of point n from delta[3 * n] on */
    double *gradient; /* of point n from gradient[9 * n] on; or NULL */
    uint8_t *moves;   /* moves[n]: what ffd_displacement returns */
} displacement_batch;

/* Must be called before the first batch, unless the scratch is zeroed, and before a batch of a lattice that
   may have the address of an earlier one. */
void ffd_displacement_scratch_clear(displacement_scratch *scratch);

/* ffd_displacement for every point of the batch, with the same bits, whatever the instruction set and the
   order and company of the points. */
void ffd_displacements(const ffd_lattice *lattice, ffd_isa isa, const displacement_batch *batch,
                       displacement_scratch *scratch);

#endif
