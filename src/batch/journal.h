/* journal.h - remembers on disk, for each output, what it was made from and the job's figures: a hash table
   of records by output; only the records in use are in memory. If the program is killed at any moment, the
   table stays valid, and an incomplete record is recognized by its check sum. Without the journal, jobs are
   only done again. default_journal.c has those that no option names. */
#ifndef FFD_BATCH_JOURNAL_H
#define FFD_BATCH_JOURNAL_H

#include "base/text/buffer.h"
#include "batch/wire.h"
#include <stdbool.h>

typedef struct job_journal job_journal;

/* Opens a journal; creates it if missing, in a folder that is there. Refuses a file that is not a journal.
   Errors: FFD_E_IO, FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_journal_open(const char *path, job_journal **journal, ffd_error *error);
/* Opens an existing journal to look up records, and changes nothing. *journal is NULL for one of another
   version. Errors: those of ffd_journal_open. */
ffd_status ffd_journal_read(const char *path, job_journal **journal, ffd_error *error);
/* Looks up the record of an output (target: ffd_place_relative, as seen from the folder of the jobs' file).
   figures: NULL, or replaced by the stored text. Returns false if there is none. */
bool ffd_journal_find(job_journal *journal, const hash128 *target, job_record *record, byte_buffer *figures);
/* Stores a record with figures of this size. Returns false on failure, which may also lose the old record. */
bool ffd_journal_put(job_journal *journal, const hash128 *target, const job_record *record,
                     const char *figures, size_t size);
/* Returns the key of the note of a copy beside an output: its content's hash is in both parts of the record.
 */
hash128 ffd_journal_copy_key(const char *base, const char *copy);
/* Writes its head anew, so that the file's time tells when it was last used. */
void ffd_journal_mark_used(job_journal *journal);
/* Closes a journal and sets *journal to NULL, which it may be already. */
void ffd_journal_close(job_journal **journal);

/* Returns the default path of a batch's journal, named by the manifest and the shard, in the user's cache
   folder (XDG_CACHE_HOME or ~/.cache; LOCALAPPDATA). Freed with ffd_free; NULL: no such folder, or out of
   memory. */
char *ffd_journal_default_path(const char *jobs, uint64_t shard, uint64_t shards);
/* Opens the journal with this path, and makes its folder. A new one removes those beside it that were not
   used for 180 days. Errors: those of ffd_journal_open. */
ffd_status ffd_journal_open_default(const char *path, job_journal **journal, ffd_error *error);

#endif
