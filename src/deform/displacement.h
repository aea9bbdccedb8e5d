/* displacement.h - the displacement of many points at once, and its derivatives by u,v,w (public functions:
   ffd/deform.h). Declares displacement.c and displacement_batch.c. */
#ifndef FFD_DEFORM_DISPLACEMENT_H
#define FFD_DEFORM_DISPLACEMENT_H

#include "base/vector/isa.h"
#include "deform/displacement_cell.h"
#include "deform/turns.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <stdint.h>

/* As ffd_displacement, with by_uvw[3*r+c] = d delta_r / d uvw_c instead of the gradient: from the right at an
   inner knot, from the left at the end of the domain. */
int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9]);

/* The most points of a batch: enough that, in a fine lattice, neighbouring rows of a mesh that cross the same
   cells are in one batch, and few enough that all data fit in the L2 cache. */
#define DISPLACEMENT_BATCH ((size_t)4096)

/* A cell of a batch, and its points. */
typedef struct batch_cell {
    size_t span[3]; /* its indices among the non-empty spans */
    size_t key;     /* its index in the lattice */
    uint32_t first, count;
} batch_cell;

/* Consecutive points of a batch that are in the same cell. */
typedef struct batch_stretch {
    uint32_t first; /* index among the points of the batch */
    uint32_t cell;  /* index among the cells of the batch */
} batch_stretch;

/* A cache of the kernel's numbers (displacement_cell.h) for cells of earlier batches, because later points of
   a mesh often are in the same cells. */
#define KEPT_CELLS ((size_t)1024)
#define KEPT_NUMBERS (KEPT_CELLS * (3 * 4 * 4 * 4 + 1))

/* The size of the caches of all threads together, 3 MB, because a machine can have many threads. */
#define KEPT_IN_ALL (2 * KEPT_NUMBERS)

/* Whether det F may be 0 or less in a cell. */
typedef enum cell_turns { TURNS_UNKNOWN, TURNS_NOWHERE, TURNS_PERHAPS } cell_turns;

typedef struct kept_cells {
    int threads;                 /* number of threads that share this size; set by the owner of the scratch
                                    memory, 0 is 1 */
    const ffd_lattice *lattice;  /* the lattice of the cells; NULL: empty */
    cell_use use;                /* what the numbers are for */
    size_t count, width;         /* capacity in cells, and numbers for each cell */
    size_t keys[KEPT_CELLS];     /* 1 + the key of a batch_cell; 0: none; `count` are in use */
    uint16_t places[KEPT_CELLS]; /* index of its numbers; assigned in ascending order, so that few pages are
                                    touched */
    uint16_t used;               /* number of used places */
    cell_motion motions[KEPT_CELLS];
    double values[KEPT_NUMBERS];
} kept_cells;

/* A cache of cell_turns: the answers for many cells, and blocks of cells, take little memory. */
#define TURN_SLOTS ((size_t)8192)

typedef struct kept_turns {
    const ffd_lattice *lattice;   /* NULL: empty */
    size_t cells;                 /* of the lattice; the keys of blocks follow those of the cells */
    size_t count;                 /* slots in use */
    uint64_t answers[TURN_SLOTS]; /* 4 times the key, plus cell_turns */
} kept_turns;

/* Scratch memory of a thread for a batch. */
typedef struct displacement_scratch {
    kept_cells kept;
    double jacobian[9 * DISPLACEMENT_BATCH];
    batch_cell cells[DISPLACEMENT_BATCH];
    size_t cell_count;
    batch_stretch stretches[DISPLACEMENT_BATCH + 1]; /* the last one only marks the end */
    size_t stretch_count;
    uint16_t buckets[2 * DISPLACEMENT_BATCH]; /* hash table of the cells by key */
    size_t bucket_count;                      /* in use */
    uint32_t sorted_room[DISPLACEMENT_BATCH];
    double uvw_room[3 * DISPLACEMENT_BATCH];
    const uint32_t *sorted;               /* indices of the points, cell by cell: there, or the batch's */
    const double *uvw;                    /* their u,v,w, likewise */
    double fields[2 * FIELD_NUMBERS + 1]; /* of a cell in which the displacement may turn */
    turn_run runs[DISPLACEMENT_BATCH];
    kept_turns kept_turns;
    turn_scratch turns;
} displacement_scratch;

/* The points of a batch, or of several, at which det F may be 0 or less. */
typedef struct turn_list {
    uint32_t points[DISPLACEMENT_BATCH];
    size_t count;
} turn_list;

typedef struct displacement_batch {
    const double *uvw; /* u,v,w of point 0; in the domain */
    size_t stride;     /* bytes from those of a point to those of the next. Not doubles: on i386 the size of a
                          struct with doubles need not be a multiple of theirs. */
    const uint32_t *which; /* the indices n of the points to compute, below DISPLACEMENT_BATCH, in strictly
                              ascending order */
    size_t count;
    double *delta;    /* of point n: begins at delta[3 * n] */
    double *gradient; /* of point n: begins at gradient[9 * n]; may be NULL */
    turn_list *turns; /* NULL, or with gradient: the points where det F may be 0 or less are added */
    bool only_turns;  /* gradients are wanted, and written, only of those points */
    uint8_t *moves;   /* moves[n]: what ffd_displacement returns */
} displacement_batch;

/* Returns u,v,w of point n. */
static inline const double *ffd_batch_uvw(const displacement_batch *batch, size_t n)
{
    return (const double *)((const char *)batch->uvw + n * batch->stride);
}

/* Clears the caches. To be called before the first batch, unless the scratch memory is zeroed, and before a
   batch of a new lattice, which could have the address of a destroyed one. */
void ffd_displacement_scratch_clear(displacement_scratch *scratch);

/* Returns the kernels of an instruction set; FFD_ISA_AUTO: of the best available one. */
const cell_kernels *ffd_cell_kernels(ffd_isa isa);

/* Computes ffd_displacement for every point of the batch, with the same bits, independently of the
   instruction set and of the other points. scratch: NULL for a few points, which groups would slow down. */
void ffd_displacements(const ffd_lattice *lattice, ffd_isa isa, const displacement_batch *batch,
                       displacement_scratch *scratch);

#endif
