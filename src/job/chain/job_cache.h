/* job_cache.h - the cache between consecutive jobs (public: ffd/job.h): the last mesh, lattices, locators of
   their rest volumes, and the locations of the mesh's vertices in one of them. */
#ifndef FFD_JOB_CHAIN_JOB_CACHE_H
#define FFD_JOB_CHAIN_JOB_CACHE_H

#include "base/file/kept_file.h"
#include "base/memory/hash.h"
#include "job/chain/chain.h"
#include "job/chain/mesh_boxes.h"
#include "mesh/mesh.h"

/* Whether the cache keeps meshes and the locations of their vertices. */
bool ffd_job_cache_holds_meshes(const ffd_job_cache *cache);
/* Takes the cached mesh out of the cache if it is the one that desc asks for, opened and with its selection
   applied, and its files have not changed; the caller owns it. Otherwise drops the cached mesh and returns
   NULL. share may be NULL in all of these functions. */
mesh_document *ffd_job_cache_take_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc,
                                       bool only_positions);
/* Records a document that was just opened as desc asks. stamp: of its file, taken before it was opened; NULL:
   none. Later changes of its files are noticed. */
void ffd_job_cache_describe_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions,
                                 const file_stamp *stamp, const mesh_document *document);
/* Hands the document to the cache if the next job can use it; else closes it. */
void ffd_job_cache_put_mesh(ffd_job_cache *cache, const ffd_deform_desc *desc, mesh_document *document);

/* Looks up the lattice that an earlier job loaded from the link's file (same path and stamp). If found, the
   link borrows it, with the hash of its rest volume and, if known, its folds, until the next
   ffd_job_cache_put_chain; it must not be changed. If not, the link is unchanged. */
void ffd_job_cache_lend_lattice(const ffd_job_cache *cache, chain_link *link);
/* Frees the lattices that are neither lent nor used by a locator, to free memory. */
void ffd_job_cache_evict_lattices(ffd_job_cache *cache);
/* Looks up a locator for the link's rest volume (by hash) and this instruction set. If found, the link
   borrows it until the next ffd_job_cache_put_chain. If not, the link is unchanged. */
void ffd_job_cache_lend_locator(const ffd_job_cache *cache, ffd_isa isa, chain_link *link);
/* Takes over the lattices and locators that the chain has made, and frees those that it did not use. */
void ffd_job_cache_put_chain(ffd_job_cache *cache, lattice_chain *chain);

/* Returns an array for the locations of a document's vertices in a rest volume. *filled: it already has them;
   else ffd_pass_over_mesh is to fill it. taken: the document came from ffd_job_cache_take_mesh. Returns NULL
   if locations are not kept. */
ffd_location *ffd_job_cache_locations(ffd_job_cache *cache, mesh_document *document, bool taken,
                                      const hash128 *rest, bool *filled);
/* Records that the pass has filled the array. */
void ffd_job_cache_locations_filled(ffd_job_cache *cache);

/* Begins a job whose output hash or mesh state is wanted. hash_output: hash the output as it is written, if
   it is one file that refers to no others. kept: bytes of the job's files that the caller has already read,
   borrowed until the job ends. */
void ffd_job_cache_begin_job(ffd_job_cache *cache, bool hash_output, kept_file *kept);
/* Hands over the bytes of the job's mesh, if the caller has kept them and the stamp still matches. Returns
   false if not. */
bool ffd_job_cache_take_bytes(ffd_job_cache *cache, const char *path, const file_stamp *stamp,
                              file_input *input);
/* Whether outputs of the current job are hashed. */
bool ffd_job_cache_hashes_output(const ffd_job_cache *cache);
/* Stores the hash of an output that was just written. */
void ffd_job_cache_put_output(ffd_job_cache *cache, const hash128 *hash);
/* Returns whether an output was hashed since ffd_job_cache_begin_job; fills its hash. */
bool ffd_job_cache_find_output(const ffd_job_cache *cache, hash128 *hash);
/* Fills a hash of the stamps of the files that the job's mesh was read from; a different one if they have
   changed since. Returns false if no mesh was read, it is not a file, or the job overwrites it. */
bool ffd_job_cache_find_state(const ffd_job_cache *cache, hash128 *state);

/* How often jobs have read a mesh, and searched for u,v,w of its vertices. */
typedef struct cache_counts {
    uint64_t reads, searches;
} cache_counts;
/* Returns the counts so far. */
cache_counts ffd_job_cache_counts(const ffd_job_cache *cache);
/* Counts a search for u,v,w. */
void ffd_job_cache_count_search(ffd_job_cache *cache);

/* Returns the boxes round the meshes that lattice files name. */
mesh_boxes *ffd_job_cache_mesh_boxes(ffd_job_cache *cache);

#endif
