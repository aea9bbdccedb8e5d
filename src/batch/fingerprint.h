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
   of the buffers that it refers to, of the images that go with it, of the lattices and the embedding. The
   files are added to files. cache is that of the jobs before. Errors: those of reading. */
ffd_status ffd_fingerprint_inputs(const ffd_deform_desc *desc, const fingerprint_words *words,
                                  hash_cache *cache, path_list *files, hash128 *hash, ffd_error *error);
/* Hashes the output, the buffers that it refers to and the images beside it. Errors: those of reading. */
ffd_status ffd_fingerprint_output(const ffd_deform_desc *desc, hash128 *hash, ffd_error *error);

#endif
