/* file_table.h - a compact table of numbers by file. The files need not exist. */
#ifndef FFD_BATCH_MANIFEST_FILE_TABLE_H
#define FFD_BATCH_MANIFEST_FILE_TABLE_H

#include "base/fail.h"
#include "base/memory/hash.h"
#include <stdbool.h>
#include <stdint.h>

/* 16 bytes a file: the first bytes of its identity, and its number. */
typedef struct file_entry {
    unsigned char file[11];
    unsigned char number[5]; /* the number plus 1; 0: free */
} file_entry;

/* All zeros: empty. */
typedef struct file_table {
    file_entry *sorted; /* count entries, contiguous: all but the recent ones */
    size_t count;
    file_entry *recent; /* hash table with open addressing, at most half full */
    size_t slots, used;
} file_table;

/* Returns a hash that identifies the file at a path, existing or not: of its absolute path with links
   resolved. */
hash128 ffd_file_identity(const char *path);
/* Sets the number of a file, which must be below 2^40 - 1. Errors: FFD_E_MEMORY. */
ffd_status ffd_files_put(file_table *table, const hash128 *file, uint64_t number, ffd_error *error);
/* Finds the number of a file. Returns false if it has none. */
bool ffd_files_find(const file_table *table, const hash128 *file, uint64_t *number);
/* Frees the entries; leaves an empty table. */
void ffd_files_free(file_table *table);

#endif
