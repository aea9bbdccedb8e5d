/* progress.h - what a batch says while it runs: to its caller's functions; or, of a program, on standard
   error, with a bar that is redrawn on a terminal, else a line from time to time. */
#ifndef FFD_BATCH_PROGRESS_H
#define FFD_BATCH_PROGRESS_H

#include "base/system/progress_bar.h"
#include <ffd/batch.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct batch_progress {
    const ffd_batch_desc *desc;
    bool draws; /* pictures are counted, not jobs */
    progress_bar bar;
} batch_progress;

/* Starts the clock. */
void ffd_progress_begin(batch_progress *progress, const ffd_batch_desc *desc);
/* Shows the progress if an update is due. fraction: of all jobs; negative: unknown. Returns false if the
   caller wants the batch to end. */
bool ffd_progress_show(batch_progress *progress, const ffd_batch_result *counts, double fraction);
/* Logs lines, each of which ends in a line break. Removes the bar before. */
void ffd_progress_print(batch_progress *progress, const char *lines);
/* Writes the final line with the counts and the time. done: the word for counts->done. */
void ffd_progress_end(batch_progress *progress, const ffd_batch_result *counts, const char *done,
                      const char *remark);

#endif
