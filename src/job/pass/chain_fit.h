/* chain_fit.h - fits lattices of a chain that take their box from the mesh. */
#ifndef FFD_JOB_PASS_CHAIN_FIT_H
#define FFD_JOB_PASS_CHAIN_FIT_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Holds faces of a link, which is fitted, as the mesh reaches it now; of blocks called once, with link 0. */
typedef ffd_status fit_seal_function(void *context, size_t link, ffd_error *error);

typedef struct fit_seals {
    fit_seal_function *seal;
    void *context;
} fit_seals;

/* Fits each lattice whose box is "mesh": to the mesh as the lattices before it leave it, or, for blocks, to
   the mesh at rest. Makes the missing locators and the chain's boxes. seals: has faces held on the way, or
   NULL. Errors: FFD_E_MEMORY, FFD_E_INVALID, FFD_E_UNSUPPORTED (a lattice reaches something that cannot be
   deformed), and those of seals. */
ffd_status ffd_chain_fit(lattice_chain *chain, mesh_document *document, int threads, const fit_seals *seals,
                         ffd_error *error);

#endif
