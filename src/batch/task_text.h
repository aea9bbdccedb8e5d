/* task_text.h - messages and report entries of ended jobs. */
#ifndef FFD_BATCH_TASK_TEXT_H
#define FFD_BATCH_TASK_TEXT_H

#include "batch/pool.h"

/* Appends the lines of a job's log and its failure, each preceded by its place in the manifest (NULL: there
   is none) and its values of placeholders. */
void ffd_task_lines(const pool_task *task, const char *manifest, byte_buffer *text);
/* Appends a job's report entry, if no worker has made it. rows: as in pool_desc. */
void ffd_task_entry(const pool_task *task, const row_array *rows, bool stable, byte_buffer *text);

#endif
