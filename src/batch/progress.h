/* progress.h - shows the progress of a batch on standard error: a bar that is redrawn on a terminal, else a
   line from time to time. */
#ifndef FFD_BATCH_PROGRESS_H
#define FFD_BATCH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct batch_counts {
    uint64_t done, skipped, failed; /* done: those that were deformed */
} batch_counts;

typedef struct batch_progress {
    bool quiet, bar; /* bar: standard error is a terminal */
    bool drawn;      /* a bar is on the screen */
    double begin, last;
} batch_progress;

/* Starts the clock. quiet: only ffd_progress_print writes. */
void ffd_progress_begin(batch_progress *progress, bool quiet);
/* Shows the progress if an update is due. fraction: of all jobs; negative: unknown. */
void ffd_progress_show(batch_progress *progress, const batch_counts *counts, double fraction);
/* Writes lines of a log as "ffd: ...". Each must end in a line break. Removes the bar before. */
void ffd_progress_print(batch_progress *progress, const char *lines);
/* Writes the final line with the counts and the time. done: the word for counts->done. */
void ffd_progress_end(batch_progress *progress, const batch_counts *counts, const char *done,
                      const char *remark);

#endif
