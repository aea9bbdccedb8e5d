/* lattice_memory.h - lattices count against the memory of a job: a line of JSON can ask for gigabytes. */
#ifndef FFD_JOB_CHAIN_LATTICE_MEMORY_H
#define FFD_JOB_CHAIN_LATTICE_MEMORY_H

#include "lattice/spec.h"
#include "mesh/memory_budget.h"

struct lattice_chain;

/* Takes from the budget what the lattice will take, before it is built; its file of this size is allowed for.
   Errors: FFD_E_LIMIT, with the bytes that it needs. */
ffd_status ffd_lattice_memory_take(memory_budget *budget, const lattice_spec *spec, uint64_t file_size,
                                   ffd_error *error);

/* Loads a lattice within the budget. Errors: those of reading and building it, FFD_E_LIMIT. */
ffd_status ffd_lattice_memory_load(const char *path, const spec_settings *settings, memory_budget *budget,
                                   ffd_lattice **lattice, ffd_error *error);

/* Takes from the budget of the job's mesh what the lattices of its chain take. Errors: FFD_E_LIMIT. */
ffd_status ffd_lattice_memory_share(const struct lattice_chain *chain, memory_budget *budget,
                                    ffd_error *error);

#endif
