/* fingerprint.h - decides by content, not by time, whether an output is up to date. */
#ifndef FFD_BATCH_FINGERPRINT_H
#define FFD_BATCH_FINGERPRINT_H

#include "batch/hash_cache.h"

/* Hashes everything that the output depends on: the job's content (batch_job.h), and the bytes
   of the mesh, its buffers, the images and material libraries copied with it, the lattices, the meshes that
   these name, the embedding, the file of the weights, and the shared box. Adds the files to `files`. cache:
   of the jobs before; may be NULL. Errors: those of reading. */
ffd_status ffd_fingerprint_inputs(const ffd_deform_desc *desc, const hash128 *content, hash_cache *cache,
                                  path_list *files, hash128 *hash, ffd_error *error);
/* Hashes the output, its buffers, and the images and material libraries beside it. Errors: those of
   reading. */
ffd_status ffd_fingerprint_output(const ffd_deform_desc *desc, hash128 *hash, ffd_error *error);
/* Whether images or material libraries are copied with the output, existing or not. True also if memory runs
   out. */
bool ffd_fingerprint_has_copies(const ffd_deform_desc *desc, hash_cache *cache);
/* Returns the hash that ffd_fingerprint_output computes for a single file without references. bytes: hash of
   the file. */
hash128 ffd_fingerprint_written(const hash128 *bytes);

#endif
