/* job_cache.h - what jobs that follow each other have in common (public: ffd/job.h): the last one's mesh, its
   lattices, what their rest volumes are searched with, and where the mesh's vertices are in one of them. */
#ifndef FFD_JOB_CHAIN_JOB_CACHE_H
#define FFD_JOB_CHAIN_JOB_CACHE_H

#include "base/memory/hash.h"
#include "job/chain/chain.h"
#include "mesh/mesh.h"

/* Whether meshes, and where their vertices are, are kept at all. */
bool ffd_cache_holds_meshes(const ffd_share *share);
/* The mesh that desc asks for, opened and with its selection applied, if it is the one that is kept and its
   files have not changed since: it is the caller's now. Else NULL, and none is kept any more. share may be
   NULL, here, above and below. */
mesh_document *ffd_cache_take_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions);
/* Takes note of a document that was just opened as desc asks, before its file had this stamp (NULL: it had
   none): what changes its files from now on is seen. */
void ffd_cache_describe_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions,
                             const file_stamp *stamp, const mesh_document *document);
/* Takes over the document that was taken or noted, where the next job can begin results on it again; else
   closes it. */
void ffd_cache_put_mesh(ffd_share *share, const ffd_deform_desc *desc, mesh_document *document);

/* Gives the link, which has its path and stamp, the lattice that a job before made of the file of this path
   when it had this stamp, with the hash of its rest volume and, where they are known, its folds: lent, and
   not to be changed, until the next ffd_cache_put_chain. Else the link stays as it is. */
void ffd_cache_lend_lattice(const ffd_share *share, chain_link *link);
/* Lets those lattices go that are not lent, nor used by a locator: there is memory for others then. */
void ffd_cache_evict_lattices(ffd_share *share);
/* Gives the link, of which the hash of the rest volume is known, the locator of such a volume for the chain's
   instructions, and its border where the chain needs one: lent until the next ffd_cache_put_chain. What is
   not there stays as it is. */
void ffd_cache_lend_locator(const ffd_share *share, const lattice_chain *chain, chain_link *link);
/* Takes the lattices and locators that the chain made, and lets those go that it did not use. */
void ffd_cache_put_chain(ffd_share *share, lattice_chain *chain);

/* Memory for the locations of a document's vertices in a rest volume, for ffd_pass_run to fill or, *filled,
   to take from. NULL: they are not kept. `taken` says whether the document was one of ffd_cache_take_mesh.
 */
ffd_location *ffd_cache_locations(ffd_share *share, mesh_document *document, bool taken, const hash128 *rest,
                                  bool *filled);
/* They are there. */
void ffd_cache_locations_filled(ffd_share *share);

#endif
