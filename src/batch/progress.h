/* progress.h - shows people on standard error how far a batch is: a bar that is drawn again and again on a
   terminal, else a line now and then. */
#ifndef FFD_BATCH_PROGRESS_H
#define FFD_BATCH_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct batch_counts {
    uint64_t done, skipped, failed; /* done: those that were deformed */
} batch_counts;

typedef struct batch_progress {
    bool quiet, bar; /* bar: it is a terminal */
    bool drawn;      /* a bar is on the screen */
    double begin, last;
} batch_progress;

/* Starts the clock. quiet: nothing but the lines of ffd_progress_print is written. */
void ffd_progress_begin(batch_progress *progress, bool quiet);
/* fraction: of all jobs, negative where it is not known. Writes where it is time to. */
void ffd_progress_show(batch_progress *progress, const batch_counts *counts, double fraction);
/* Lines "ffd: ..." of a log, each ended by a line break, where no bar is in their way. */
void ffd_progress_print(batch_progress *progress, const char *lines);
/* The last word: what was done, and in which time. done: what counts->done are. */
void ffd_progress_end(batch_progress *progress, const batch_counts *counts, const char *done,
                      const char *remark);

#endif
