/* job_cache.h - what jobs that follow each other have in common (public: ffd/job.h): the last one's mesh, its
   lattices, what their rest volumes are searched with, and where the mesh's vertices are in one of them. */
#ifndef FFD_JOB_CHAIN_JOB_CACHE_H
#define FFD_JOB_CHAIN_JOB_CACHE_H

#include "base/file/kept_file.h"
#include "base/memory/hash.h"
#include "job/chain/chain.h"
#include "job/chain/mesh_boxes.h"
#include "mesh/mesh.h"

/* A share for one job alone, which goes over its mesh several times. */
ffd_status ffd_cache_create_for_job(ffd_share **share, ffd_error *error);
/* Whether it is one that several jobs have. share may be NULL. */
bool ffd_cache_is_of_batch(const ffd_share *share);
/* Whether meshes, and where their vertices are, are kept at all. */
bool ffd_cache_holds_meshes(const ffd_share *share);
/* Returns the mesh that desc asks for, opened and with its selection applied, if it is the cached one and its
   files have not changed since; the caller owns it. Otherwise drops the cached mesh and returns NULL. share
   may be NULL in all of these functions. */
mesh_document *ffd_cache_take_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions);
/* Takes note of a document that was just opened as desc asks, before its file had this stamp (NULL: it had
   none): what changes its files from now on is seen. */
void ffd_cache_describe_mesh(ffd_share *share, const ffd_deform_desc *desc, bool only_positions,
                             const file_stamp *stamp, const mesh_document *document);
/* Takes over the document that was taken or noted, where the next job can begin results on it again; else
   closes it. */
void ffd_cache_put_mesh(ffd_share *share, const ffd_deform_desc *desc, mesh_document *document);

/* Looks up the lattice that an earlier job made of the link's file (its path and stamp), and gives it to the
   link with the hash of its rest volume and, if they are known, its folds. It is lent until the next
   ffd_cache_put_chain and must not be changed. If there is none, the link stays as it is. */
void ffd_cache_lend_lattice(const ffd_share *share, chain_link *link);
/* Frees the lattices that are neither lent nor used by a locator, to make memory for others. */
void ffd_cache_evict_lattices(ffd_share *share);
/* Looks up the locator for the link's rest volume, by its hash, and the instruction set, and gives it to the
   link. It is lent until the next ffd_cache_put_chain. If there is none, the link stays as it is. */
void ffd_cache_lend_locator(const ffd_share *share, ffd_isa isa, chain_link *link);
/* Takes the lattices and locators that the chain made, and frees those that it did not use. */
void ffd_cache_put_chain(ffd_share *share, lattice_chain *chain);

/* Memory for the locations of a document's vertices in a rest volume, for ffd_pass_run to fill or, *filled,
   to take from. NULL: they are not kept. `taken` says whether the document was one of ffd_cache_take_mesh.
 */
ffd_location *ffd_cache_locations(ffd_share *share, mesh_document *document, bool taken, const hash128 *rest,
                                  bool *filled);
/* They are there. */
void ffd_cache_locations_filled(ffd_share *share);

/* Called before a job of which more is to be known than its result. hash_output: the bytes of its output are
   hashed as they are written, where it is one file that refers to no other. kept: what the caller has read of
   the job's files, lent until the job ends. */
void ffd_cache_begin_job(ffd_share *share, bool hash_output, kept_file *kept);
/* Hands over the bytes of the job's mesh, if the caller has kept them and the file has this stamp still. */
bool ffd_cache_take_bytes(ffd_share *share, const char *path, const file_stamp *stamp, file_input *input);
/* Whether they are. */
bool ffd_cache_hashes_output(const ffd_share *share);
/* Takes the hash of an output that was just written. */
void ffd_cache_put_output(ffd_share *share, const hash128 *hash);
/* Gives the hash of the output since ffd_cache_begin_job; false: there is none. */
bool ffd_cache_find_output(const ffd_share *share, hash128 *hash);
/* Gives a hash of the stamps of the files that the job's mesh was read from, another one where they have
   changed since; false: it was not read, is no file, or is overwritten by the job. */
bool ffd_cache_find_state(const ffd_share *share, hash128 *state);

/* How often the jobs have read a mesh, and looked for u,v,w of its vertices. */
typedef struct share_counts {
    uint64_t reads, searches;
} share_counts;
/* Returns the counts so far. */
share_counts ffd_cache_counts(const ffd_share *share);
/* u,v,w are looked for. */
void ffd_cache_count_search(ffd_share *share);

/* The boxes round meshes that lattice files name. */
mesh_boxes *ffd_cache_mesh_boxes(ffd_share *share);

#endif
