/* chain_load.h - reads the lattices of a chain, and makes what they are searched with. */
#ifndef FFD_JOB_CHAIN_CHAIN_LOAD_H
#define FFD_JOB_CHAIN_CHAIN_LOAD_H

#include "job/chain/chain.h"

/* The lattice files of a chain, with the values of their placeholders. */
typedef struct chain_files {
    const char *const *paths; /* count */
    size_t count;
    const ffd_setting *set; /* set_count, or NULL */
    size_t set_count;
} chain_files;

/* Makes a chain of these lattice files. share may be NULL; else it must outlive the chain, and gets what the
   chain made by ffd_cache_put_chain. */
ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_share *share, lattice_chain *chain, ffd_error *error);

/* Makes the locator and border of a link whose lattice is fitted. */
ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error);

#endif
