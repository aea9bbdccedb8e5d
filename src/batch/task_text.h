/* task_text.h - what is said of a job that has ended: to people, and in the report. */
#ifndef FFD_BATCH_TASK_TEXT_H
#define FFD_BATCH_TASK_TEXT_H

#include "batch/pool.h"

/* Appends the lines of its log and of its failure, each with its place in the manifest (NULL: there is none)
   and the values that it sets. */
void ffd_task_lines(const pool_task *task, const char *manifest, byte_buffer *text);
/* Appends its entry of the report, where no worker has made it. rows: as pool_desc has them. */
void ffd_task_entry(const pool_task *task, const row_array *rows, bool stable, byte_buffer *text);

#endif
