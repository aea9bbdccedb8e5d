/* file_table.h - a compact table of indices by the place of a file (place.h). */
#ifndef FFD_BASE_MEMORY_FILE_TABLE_H
#define FFD_BASE_MEMORY_FILE_TABLE_H

#include "base/fail.h"
#include "base/memory/hash.h"
#include <stdbool.h>
#include <stdint.h>

/* 16 bytes a file: the first bytes of its place, and its index. */
typedef struct file_entry {
    unsigned char file[11];
    unsigned char index[5]; /* the index plus 1; 0: free */
} file_entry;

/* All zeros: empty. */
typedef struct file_table {
    file_entry *sorted; /* count entries, contiguous: all but the recent ones */
    size_t count;
    file_entry *recent; /* hash table with open addressing, at most half full */
    size_t slots, used;
} file_table;

/* Sets the index of a file, which must be below 2^40 - 1. Errors: FFD_E_MEMORY. */
ffd_status ffd_files_put(file_table *table, const hash128 *file, uint64_t index, ffd_error *error);
/* Finds the index of a file. Returns false if it has none. */
bool ffd_files_find(const file_table *table, const hash128 *file, uint64_t *index);
/* Frees the entries; leaves an empty table. */
void ffd_files_free(file_table *table);

#endif
