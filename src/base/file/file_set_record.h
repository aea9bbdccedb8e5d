/* file_set_record.h - the record of a set of files that is being placed (file_set.h): which files it has, and
   how to recognise the new ones. It is in the folder of the head, locked as long as its run lives, and
   trusted only if it belongs to the user. */
#ifndef FFD_BASE_FILE_FILE_SET_RECORD_H
#define FFD_BASE_FILE_FILE_SET_RECORD_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct set_entry {
    char *target;    /* the path of the file */
    char *aside;     /* the path to which the old file is renamed */
    bool was_there;  /* there was an old file */
    uint64_t size;   /* of the new file */
    int64_t time[2]; /* modification time of the new file: seconds, nanoseconds */
} set_entry;

/* The entries in the order of placing, the head last. All zeros: empty. */
typedef struct set_record {
    set_entry *entries;
    size_t count, capacity;
    char *path; /* of the record itself */
    int fd;     /* open and locked; -1: none */
} set_record;

/* Begins the record of a head, in memory. Errors: FFD_E_MEMORY. */
ffd_status ffd_record_begin(set_record *record, const char *head, ffd_error *error);
/* Adds a file. Errors: FFD_E_MEMORY. */
ffd_status ffd_record_add(set_record *record, const char *target, bool was_there, uint64_t size,
                          const int64_t time[2], ffd_error *error);
/* Writes the record to its file. Errors: FFD_E_IO (also if the file exists), FFD_E_MEMORY. */
ffd_status ffd_record_write(set_record *record, ffd_error *error);
/* Opens, locks and reads the record that a run has left next to a head; waits up to a second for a run that
   still lives. fd is -1 if there is none. If it has no entries, the run had not renamed anything yet. Errors:
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_record_open(set_record *record, const char *head, ffd_error *error);
/* Returns whether there is a record next to the head. */
bool ffd_record_exists(const char *head);
/* Removes the record's file. Returns 0, or -1 and errno. */
int ffd_record_remove(const set_record *record);
/* Frees the memory and releases the lock; the file stays. */
void ffd_record_free(set_record *record);

#endif
