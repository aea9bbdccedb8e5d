/* coverage.h - why vertices among a lattice's control points may be outside of its volume. */
#ifndef FFD_JOB_CHAIN_COVERAGE_H
#define FFD_JOB_CHAIN_COVERAGE_H

#include "job/chain/chain.h"
#include <ffd/job.h>

/* Where a lattice's knots are not repeated d+1 times at their ends its volume covers the domain [t_d, t_n]
   only, and that is less than the control points reach (src/maths.md 4.4). Writes for the first lattice of
   which this is so, with control points that the file gives, what it covers and the remedy; else "". Lattices
   that are made from a box or a cylinder cover these, whatever the knots. */
void ffd_chain_coverage(const lattice_chain *chain, char *text, size_t capacity);

#endif
