/* seals.h - faces of a chain's lattices that are held still, so that what is deformed joins what is not
   (`--seam`). */
#ifndef FFD_JOB_CHAIN_SEALS_H
#define FFD_JOB_CHAIN_SEALS_H

#include "job/chain/chain.h"
#include "mesh/mesh_log.h"

/* Returns the faces of a lattice that are named; if all are, those of its directions that are not closed. */
unsigned ffd_seal_named(const chain_seal *seal, const ffd_lattice *lattice);

/* Gives the chain what its lattices are to be held by, before they are fitted. Checks the faces, unless the
   mesh is to tell them, and charges the lattices with held faces to the chain's memory. Errors:
   FFD_E_ARGUMENT, FFD_E_LIMIT. */
ffd_status ffd_seals_begin(lattice_chain *chain, const chain_seal *seal, ffd_error *error);
/* Holds these faces of a link whose lattice is fitted; none: it stays as it is. Errors: those of
   ffd_lattice_seal, which name the lattice. */
ffd_status ffd_seal_link(lattice_chain *chain, size_t link, unsigned faces, ffd_error *error);
/* Tells which faces of a lattice the meshes cut, and how many vertices outside have a neighbour inside: as a
   warning, or, where they cut none, as information. */
void ffd_seal_tell(const char *name, int continuity, size_t meshes, unsigned faces, uint64_t vertices,
                   const mesh_log *log);
/* Warns if held faces leave nothing that moves of a lattice that moved something. name: of the lattice. */
void ffd_seal_warn(const ffd_lattice *before, const ffd_lattice *sealed, int continuity, const char *name,
                   const mesh_log *log);

#endif
