/* chain_apply.h - sends points through the lattices of a chain. */
#ifndef FFD_JOB_CHAIN_CHAIN_APPLY_H
#define FFD_JOB_CHAIN_CHAIN_APPLY_H

#include "job/chain/chain.h"

/* Replaces the gradient E1 of a deformation by that of two, one after the other: F = F2 F1, written with E =
   F - I: E = E1 + E2 + E2 E1. Zeros stay exact. */
void ffd_gradients_compose(double gradient[9], const double next[9]);

/* Sends the points through the first `links` links, or through all blocks if links is not 0. Errors:
   FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error);

/* Sends the points through the first `links` links, and finds whether the link behind them, or, of blocks,
   any of them holds the points: of outcomes located and outside are of that alone, all else is undefined.
   locates: fill scratch->locations, too. Errors: as above. */
ffd_status ffd_chain_locate(const lattice_chain *chain, size_t links, bool locates, chain_run *run,
                            ffd_error *error);

#endif
