/* task_record.h - a job that has ended and waits for its picture, as bytes: all that is still to be told of
   it. */
#ifndef FFD_BATCH_TASK_RECORD_H
#define FFD_BATCH_TASK_RECORD_H

#include "batch/pool.h"

/* Replaces the record by that of a task. Errors: FFD_E_MEMORY. */
ffd_status ffd_task_write(const pool_task *task, byte_buffer *record, ffd_error *error);
/* Fills a task of zeros, which takes the record over. Errors: FFD_E_MEMORY. */
ffd_status ffd_task_read(byte_buffer *record, pool_task *task, ffd_error *error);

#endif
