/* pass.h - one pass over all vertices of a document: read a tile, embed, deform, hand the results back,
   count. Only tiles are in memory as doubles. Tiles are the same for any number of threads, and their sums
   are joined in order. */
#ifndef FFD_JOB_PASS_PASS_H
#define FFD_JOB_PASS_PASS_H

#include "job/pass/mesh_pass.h"
#include "job/pass/pass_totals.h"

/* Bytes that a thread of a pass may take, and one that measures edges after it (quality_edges.h), the latter
   for each lattice too. */
#define THREAD_BYTES ((size_t)5 << 20)
#define THREAD_LINK_BYTES ((size_t)400 << 10)

/* Returns for how many of the threads the rest of the memory budget suffices. edge_links: the number of
   lattices through which they will measure edges; 0: none. */
int ffd_pass_threads(const memory_budget *budget, size_t edge_links, int threads);

/* Sends all vertices of the document through the chain, and counts. Errors: FFD_E_MEMORY, and those of a
   search (ffd_chain_apply). */
ffd_status ffd_pass_run(const mesh_pass *pass, pass_totals *totals, ffd_error *error);

#endif
