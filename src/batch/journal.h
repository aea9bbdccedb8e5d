/* journal.h - remembers on disk what each output was made of, and the figures of that job: a hash table of
   records by output, of which only the records being looked at are in memory. A program that is ended at any
   moment leaves a valid table, in which a record that is not complete shows that it is not. Losing it costs
   only the time to do jobs again. */
#ifndef FFD_BATCH_JOURNAL_H
#define FFD_BATCH_JOURNAL_H

#include "base/text/buffer.h"
#include "batch/wire.h"
#include <stdbool.h>

typedef struct job_journal job_journal;

/* Opens the journal of that name, made where it does not exist, with its folder; a file that is not a journal
   is refused. Errors: FFD_E_IO, FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_journal_open(const char *path, job_journal **journal, ffd_error *error);
/* What is known of an output (ffd_file_identity). figures: NULL, or gets the text that was put; it is emptied
   before. */
bool ffd_journal_find(job_journal *journal, const hash128 *target, job_record *record, byte_buffer *figures);
/* Stores the record with a text of this size. Returns false if that failed; the record before may then be
   lost. */
bool ffd_journal_put(job_journal *journal, const hash128 *target, const job_record *record,
                     const char *figures, size_t size);
/* Sets *journal to NULL; it may be NULL before. */
void ffd_journal_close(job_journal **journal);

/* The default path of a batch's journal: in the user's cache (XDG_CACHE_HOME or ~/.cache; LOCALAPPDATA),
   named by the manifest and the shard. Free with ffd_free; NULL if there is no such folder, or no memory. */
char *ffd_journal_default_path(const char *jobs, uint64_t shard, uint64_t shards);

#endif
