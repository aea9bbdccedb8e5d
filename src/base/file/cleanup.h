/* cleanup.h - what must be removed when a signal ends the program: temporary files, and folders
   that were made for them.

   The list is guarded by a lock that its holder keeps only while signals wait, so that a handler can take it:
   in the holder's thread no handler runs, in other threads the handler waits its turn. The list lives in
   memory of one process; what a parent noted a forked child leaves alone. A child must not be forked while
   another thread holds the lock. */
#ifndef FFD_BASE_FILE_CLEANUP_H
#define FFD_BASE_FILE_CLEANUP_H

#include <stddef.h>

typedef struct cleanup_entry cleanup_entry;

/* Between these two, signals wait and other threads take no part: to make a file and note it, or to rename it
   and strike it off, as one step. Not nested; not for what takes long. */
void ffd_cleanup_hold(void);
/* Lets signals and other threads go on. */
void ffd_cleanup_release(void);

/* Notes a file of this name (copied). Only while held. NULL: no memory. */
cleanup_entry *ffd_cleanup_note(const char *path);
/* Notes a folder as ffd_folder_make has made it. Only while held. NULL: no memory. */
cleanup_entry *ffd_cleanup_note_folder(const char *path, size_t made);
/* Strikes off, frees and clears the pointer. Only while held. A pointer to NULL is allowed. */
void ffd_cleanup_strike(cleanup_entry **entry);

/* In a worker: the same that ffd_cleanup_on_signals does for signals from outside, for SIGALRM, by which
   ffd_process_stop ends it, and for those of a crash. */
void ffd_cleanup_on_crashes(void);

#endif
