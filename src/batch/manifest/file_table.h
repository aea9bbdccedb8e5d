/* file_table.h - a number for each of many files, which need not exist yet, in little memory. */
#ifndef FFD_BATCH_MANIFEST_FILE_TABLE_H
#define FFD_BATCH_MANIFEST_FILE_TABLE_H

#include "base/fail.h"
#include "base/memory/hash.h"
#include <stdbool.h>
#include <stdint.h>

/* 16 bytes a file: the first bytes of its identity, and its number. */
typedef struct file_entry {
    unsigned char file[11];
    unsigned char number[5]; /* 0: free; else 1 more */
} file_entry;

/* All zeros: empty. */
typedef struct file_table {
    file_entry *sorted; /* count: all but the last ones, without gaps */
    size_t count;
    file_entry *recent; /* the last ones: slots with open addressing, at most half of them in use */
    size_t slots, used;
} file_table;

/* Which file a path leads to, whether it is there or not: the hash of its full path without links. */
hash128 ffd_file_identity(const char *path);
/* Sets the number of a file, below 2^40 - 1. Errors: FFD_E_MEMORY. */
ffd_status ffd_files_put(file_table *table, const hash128 *file, uint64_t number, ffd_error *error);
/* Whether a file has a number, and which. */
bool ffd_files_find(const file_table *table, const hash128 *file, uint64_t *number);
/* Leaves an empty table. */
void ffd_files_free(file_table *table);

#endif
