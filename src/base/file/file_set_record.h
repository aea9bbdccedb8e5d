/* file_set_record.h - the record of a set of files that is being placed (file_set.h): which files it has, and
   how to tell the new ones from others. It stands beside the head, is locked as long as its run lives, and
   is trusted only where it is the user's own. */
#ifndef FFD_BASE_FILE_FILE_SET_RECORD_H
#define FFD_BASE_FILE_FILE_SET_RECORD_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct set_entry {
    char *target;    /* the path of the file */
    char *aside;     /* where the old file goes */
    bool was_there;  /* an old file stood there */
    uint64_t size;   /* of the new file */
    int64_t time[2]; /* when the new file was written: seconds, nanoseconds */
} set_entry;

/* The entries in the order of placing: the head is the last. Zeroed: none. */
typedef struct set_record {
    set_entry *entries;
    size_t count, capacity;
    char *path; /* of the record itself */
    int fd;     /* open and locked; -1: not */
} set_record;

/* Begins a record beside the head, in memory. Errors: FFD_E_MEMORY. */
ffd_status ffd_record_begin(set_record *record, const char *head, ffd_error *error);
/* Adds a file. Errors: FFD_E_MEMORY. */
ffd_status ffd_record_add(set_record *record, const char *target, bool was_there, uint64_t size,
                          const int64_t time[2], ffd_error *error);
/* Makes the file of the record. Errors: FFD_E_IO (also where there is one already), FFD_E_MEMORY. */
ffd_status ffd_record_write(set_record *record, ffd_error *error);
/* Opens, locks and reads the record that is left beside a head; a run that still lives is waited for, a
   second at most. fd is -1: there is none. No entries: its run had not yet renamed anything. Errors:
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_record_open(set_record *record, const char *head, ffd_error *error);
/* Whether there is a record beside the head. */
bool ffd_record_exists(const char *head);
/* Removes the record's file. Returns 0, or -1 and errno. */
int ffd_record_remove(const set_record *record);
/* Frees what is in memory and gives up the lock; the file stays. */
void ffd_record_free(set_record *record);

#endif
