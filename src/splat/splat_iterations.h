/* splat_iterations.h - the two iterations of splats, on many matrices, with the same bits whatever the
   instruction set. Used within splat only. */
#ifndef FFD_SPLAT_SPLAT_ITERATIONS_H
#define FFD_SPLAT_SPLAT_ITERATIONS_H

#include "base/vector/isa.h"
#include <stddef.h>

/* Replaces matrices that have inverses with the orthogonal factors of their polar decompositions. */
void ffd_splats_orthogonalise(ffd_isa isa, double (*nines)[9], size_t count);

/* Makes the columns of matrices, one column after the other, perpendicular. */
void ffd_splats_part_columns(ffd_isa isa, double (*nines)[9], size_t count);

#endif
