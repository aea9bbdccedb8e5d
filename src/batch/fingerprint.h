/* fingerprint.h - decides whether an output is up to date: by content, not by time. */
#ifndef FFD_BATCH_FINGERPRINT_H
#define FFD_BATCH_FINGERPRINT_H

#include "batch/hash_cache.h"
#include <stdint.h>

/* What a job says (batch_job's content). */
typedef struct fingerprint_words {
    const char *first; /* each ended by 0 */
    uint32_t count;
} fingerprint_words;

/* Hashes all that the output depends on: the program's version, what the job says, and the bytes of the mesh,
   of the buffers that it refers to, of the images and material libraries that go with it, of the lattices, of
   the meshes that they name, and the embedding; and the box that it shares with other jobs. The files are
   added to files. cache is that of the jobs before. Errors: those of reading. */
ffd_status ffd_fingerprint_inputs(const ffd_deform_desc *desc, const fingerprint_words *words,
                                  hash_cache *cache, path_list *files, hash128 *hash, ffd_error *error);
/* Hashes the output, the buffers that it refers to, and the images and material libraries beside it. Errors:
 * those of reading. */
ffd_status ffd_fingerprint_output(const ffd_deform_desc *desc, hash128 *hash, ffd_error *error);
/* Whether images or material libraries go with the output, be they there or not. True too where memory runs
   out. */
bool ffd_fingerprint_has_copies(const ffd_deform_desc *desc, hash_cache *cache);
/* The same of an output that is one file which refers to no other, by the hash of its bytes. */
hash128 ffd_fingerprint_written(const hash128 *bytes);

#endif
