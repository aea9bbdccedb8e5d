/* lattice_memory.h - charges lattices to the memory budget of a job: a line of JSON can ask for gigabytes. */
#ifndef FFD_JOB_CHAIN_LATTICE_MEMORY_H
#define FFD_JOB_CHAIN_LATTICE_MEMORY_H

#include "lattice/spec.h"
#include "mesh/memory_budget.h"

struct lattice_chain;

/* Takes from the budget the memory of a lattice before it is built. file_size: size of its file, which raises
   the limit. Errors: FFD_E_LIMIT, with the bytes needed. */
ffd_status ffd_lattice_memory_take(memory_budget *budget, const lattice_spec *spec, uint64_t file_size,
                                   ffd_error *error);

/* Loads a lattice within the budget. Errors: those of reading and building it, FFD_E_LIMIT. */
ffd_status ffd_lattice_memory_load(const ffd_lattice_source *source, const spec_settings *settings,
                                   memory_budget *budget, ffd_lattice **lattice, ffd_error *error);

/* Takes the memory of the chain's lattices from the budget of the job's mesh. Errors: FFD_E_LIMIT. */
ffd_status ffd_lattice_memory_share(const struct lattice_chain *chain, memory_budget *budget,
                                    ffd_error *error);

#endif
