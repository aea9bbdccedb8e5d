/* journal.h - remembers on disk what each output was made of: a table of records by output, of which one
   needs no more in memory than is being looked at. A program that is ended at any moment leaves a table that
   is whole but for records that show that they are not. Losing it costs only the time to do jobs again. */
#ifndef FFD_BATCH_JOURNAL_H
#define FFD_BATCH_JOURNAL_H

#include "base/fail.h"
#include "batch/wire.h"
#include <stdbool.h>

typedef struct job_journal job_journal;

/* Opens the journal of that name, made where it does not exist, with its folder; a file that is not a journal
   is refused. Errors: FFD_E_IO, FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_journal_open(const char *path, job_journal **journal, ffd_error *error);
/* What is known of the output at target. */
bool ffd_journal_find(job_journal *journal, const char *target, job_record *record);
/* Remembers it. False where that failed: what was known may then be forgotten. */
bool ffd_journal_put(job_journal *journal, const char *target, const job_record *record);
/* Sets *journal to NULL; it may be NULL before. */
void ffd_journal_close(job_journal **journal);

/* The default path of a batch's journal: in the user's cache (XDG_CACHE_HOME or ~/.cache; LOCALAPPDATA),
   named by the manifest and the shard. Free with ffd_free; NULL if there is no such folder, or no memory. */
char *ffd_journal_default_path(const char *jobs, uint64_t shard, uint64_t shards);

#endif
