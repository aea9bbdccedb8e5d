/* pass.h - one pass over all vertices of a document: read a tile, embed, deform, hand the results back,
   count. Only tiles are in memory as doubles. Tiles are the same for any number of threads, and their sums
   are joined in order. */
#ifndef FFD_JOB_PASS_PASS_H
#define FFD_JOB_PASS_PASS_H

#include "job/pass/mesh_pass.h"
#include "job/pass/pass_totals.h"

/* What a thread of a pass may take, and of what looks at edges after it (quality.h): the latter for each
   lattice too. */
#define THREAD_BYTES ((size_t)5 << 20)
#define THREAD_LINK_BYTES ((size_t)400 << 10)

/* How many of the threads there is memory for, beside what is taken of the budget. edge_links: the lattices
   through which they will look at edges; 0: they will not. */
int ffd_pass_threads(const memory_budget *budget, size_t edge_links, int threads);

/* Sends all vertices of the document through the chain, and counts. Errors: FFD_E_MEMORY, and those of a
   search (ffd_chain_apply). */
ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error);

#endif
