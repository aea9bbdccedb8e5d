/* record_queue.h - records that wait, first in, first out, in an unnamed file (unnamed_file.h), so that their
   number costs no memory. Where there is no such file, or its disk is full, they wait in memory. */
#ifndef FFD_BASE_FILE_RECORD_QUEUE_H
#define FFD_BASE_FILE_RECORD_QUEUE_H

#include "base/fail.h"
#include "base/text/buffer.h"
#include <stdbool.h>
#include <stdint.h>

/* All zeros: empty. */
typedef struct record_queue {
    int file; /* if has_file */
    bool has_file, is_tried;
    uint64_t written, taken; /* bytes of the file */
    byte_buffer rest;        /* the records behind those of the file, */
    size_t rest_taken;       /* and how many bytes of them were taken */
} record_queue;

/* Adds a record. Errors: FFD_E_MEMORY. */
ffd_status ffd_records_put(record_queue *queue, const byte_buffer *record, ffd_error *error);
/* Takes the next record. *found: false if there is none. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_records_take(record_queue *queue, byte_buffer *record, bool *found, ffd_error *error);
/* Drops all records; leaves an empty queue. */
void ffd_records_free(record_queue *queue);

#endif
