/* index_entry.h - what the page of a run says of a job, out of its entry of a report. */
#ifndef FFD_BATCH_INDEX_ENTRY_H
#define FFD_BATCH_INDEX_ENTRY_H

#include "base/text/buffer.h"
#include "view/index.h"

/* The row and the texts that it lends from. All zeros: empty. */
typedef struct index_entry {
    index_row row;
    char *texts[4];
    size_t text_count;
} index_entry;

/* Reads an entry, an object of JSON; its picture is not among the row's members. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_index_entry_read(const byte_buffer *text, index_entry *entry, ffd_error *error);
/* Leaves an empty one. */
void ffd_index_entry_free(index_entry *entry);

#endif
