/* turns.h - finds where a displacement may turn space inside out (det F <= 0), by bounds that hold in a whole
   cell or in a box round some of its points (src/maths.md 7.5). Elsewhere no derivatives are needed to know
   that it does not. */
#ifndef FFD_DEFORM_TURNS_H
#define FFD_DEFORM_TURNS_H

#include "deform/displacement_cell.h"
#include "deform/slope_kernel.h"

/* Points of a cell that are looked at together, by a box round them: as they have consecutive numbers in the
   mesh, they mostly are neighbours. */
typedef struct turn_run {
    uint32_t first, end;
    bool may_turn; /* false: det F > 0 is known */
} turn_run;

/* The kernels of an instruction set. */
typedef struct cell_kernels {
    extraction_kernel *extract;
    displacement_kernel *displace;
    slope_kernel *find_slopes;
} cell_kernels;

/* A cell with unequal displacements. */
typedef struct turn_cell {
    const ffd_lattice *lattice;
    const size_t *index; /* its indices among the non-empty spans */
    const cell_kernels *kernels;
} turn_cell;

/* Scratch memory; order[0] is 0 before the first call. */
typedef struct turn_scratch {
    double field[3 * CELL_POINTS + 1], points[3 * CELL_POINTS + 1], steps[3 * CELL_POINTS + 1];
    double factors[CELL_POINTS]; /* of bezier_factors for cells with this order in each direction */
    size_t order[3];
} turn_scratch;

/* Returns whether det F > 0 is known in the whole cell. difference: the points of the displacement, in the
   kernel's form. */
bool ffd_turns_nowhere(const turn_cell *cell, const double *difference, turn_scratch *scratch);

/* Cells along each direction of a block of cells. */
#define BLOCK_SIDE ((size_t)4)

/* Returns whether det F > 0 is known in a block of cells. block: its indices, those of its first cell divided
   by BLOCK_SIDE. */
bool ffd_turns_nowhere_in_block(const ffd_lattice *lattice, slope_kernel *find_slopes, const size_t block[3],
                                turn_scratch *scratch);

/* Divides the points of a cell into runs, and returns their number. which: the points' numbers, ascending;
   uvw: 3 numbers a point, in the cell. fields: those of the cell, with what derivatives by position need.
   runs: room for as many as points. */
size_t ffd_turns_find(const turn_cell *cell, const kernel_cell *fields, const uint32_t *which,
                      const double *uvw, size_t count, turn_run *runs, turn_scratch *scratch);

#endif
