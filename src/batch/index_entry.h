/* index_entry.h - makes a row of the comparing page from a job's entry of the report. */
#ifndef FFD_BATCH_INDEX_ENTRY_H
#define FFD_BATCH_INDEX_ENTRY_H

#include "base/text/buffer.h"
#include "view/index.h"

/* A row, and the texts that it refers to. All zeros: empty. */
typedef struct index_entry {
    index_row row;
    ffd_job_result figures;
    char *texts[3];
    size_t text_count;
} index_entry;

/* Fills the row, which refers to *entry, from an entry, a JSON object; except for its picture. Errors:
 * FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_index_entry_read(const byte_buffer *text, index_entry *entry, ffd_error *error);
/* Frees the texts; leaves an empty entry. */
void ffd_index_entry_free(index_entry *entry);

#endif
