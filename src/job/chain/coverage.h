/* coverage.h - explains why vertices among a lattice's control points may be outside of its volume. */
#ifndef FFD_JOB_CHAIN_COVERAGE_H
#define FFD_JOB_CHAIN_COVERAGE_H

#include "job/chain/chain.h"
#include <ffd/job.h>

/* If the end knots of a lattice are not repeated d+1 times, the volume covers only the domain [t_d, t_n],
   which is smaller than the hull of the control points (src/maths.md 4.4). Writes the covered range and the
   remedy for the first lattice of this kind whose control points come from the file; else "". Lattices made
   from a box or a cylinder cover it, whatever the knots. */
void ffd_chain_coverage(const lattice_chain *chain, char *text, size_t capacity);

#endif
