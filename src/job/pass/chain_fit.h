/* chain_fit.h - fits lattices of a chain that take their box from the mesh. */
#ifndef FFD_JOB_PASS_CHAIN_FIT_H
#define FFD_JOB_PASS_CHAIN_FIT_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Fits each lattice whose box is "mesh": to the mesh as the lattices before it leave it, or, for blocks, to
   the mesh at rest. Makes the missing locators and the chain's boxes. Errors: FFD_E_MEMORY, FFD_E_INVALID,
   FFD_E_UNSUPPORTED (a lattice reaches something that cannot be deformed). */
ffd_status ffd_chain_fit(lattice_chain *chain, mesh_document *document, int threads, ffd_error *error);

#endif
