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
/* Writes the progress if it is time to. fraction: of all jobs; negative if it is not known. */
void ffd_progress_show(batch_progress *progress, const batch_counts *counts, double fraction);
/* Writes lines "ffd: ..." of a log, each ended by a line break, and moves the bar out of their way. */
void ffd_progress_print(batch_progress *progress, const char *lines);
/* Writes the last line: what was done, and in which time. done: what counts->done are. */
void ffd_progress_end(batch_progress *progress, const batch_counts *counts, const char *done,
                      const char *remark);

#endif
