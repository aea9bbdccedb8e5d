/* pass.h - one pass over all vertices of a document: read a tile, embed, deform, write results, count. Only
   tiles are held as doubles. The division into tiles does not depend on the number of threads, and their sums
   are joined in order. */
#ifndef FFD_JOB_PASS_PASS_H
#define FFD_JOB_PASS_PASS_H

#include "job/figures/pass_totals.h"
#include "job/pass/mesh_pass.h"

/* Memory per thread of a pass, and additionally, for each lattice, of the measuring of edges after it
   (quality_edges.h). */
#define THREAD_BYTES ((size_t)23 << 18)
#define THREAD_LINK_BYTES ((size_t)400 << 10)

/* Returns how many threads, at most `threads`, fit into the rest of the memory budget. edge_links: the number
   of lattices through which they will measure edges, or 0. */
int ffd_pass_threads(const memory_budget *budget, size_t edge_links, int threads);

/* Sends all vertices of the document through the chain, and counts. Errors: FFD_E_MEMORY, and those of
   ffd_chain_apply. */
ffd_status ffd_pass_over_mesh(const mesh_pass *pass, pass_totals *totals, ffd_error *error);

#endif
