/* cleanup.h - removes temporary files, and folders that were created for them, when a signal ends the
   program.

   A lock protects the list. Its holder blocks signals, so a handler can take the lock safely: no handler runs
   in the thread that holds it, and in other threads the handler waits. (The lock and the handlers are in
   cleanup_signals.c and cleanup_signals_windows.c.) The list belongs to one process: a
   forked child does not remove what its parent has noted. Do not fork while another thread holds the lock. */
#ifndef FFD_BASE_FILE_CLEANUP_H
#define FFD_BASE_FILE_CLEANUP_H

#include <stddef.h>

typedef struct cleanup_entry cleanup_entry;

/* Takes the lock and blocks signals, to make one step of creating a file and noting it, or of renaming a file
   and striking it off. Not recursive; hold it for a short time only. */
void ffd_cleanup_hold(void);
/* Releases the lock and unblocks signals. */
void ffd_cleanup_release(void);

/* Adds a file to the list; path is copied. The caller holds the lock. Returns NULL if memory runs out. */
cleanup_entry *ffd_cleanup_note(const char *path);
/* Adds folders that ffd_folder_make has made. The caller holds the lock. Returns NULL if memory runs out. */
cleanup_entry *ffd_cleanup_note_folder(const char *path, size_t made);
/* Removes the entry from the list, frees it, and sets *entry to NULL. The caller holds the lock. *entry may
   be NULL. */
void ffd_cleanup_strike(cleanup_entry **entry);

/* In a worker: as ffd_cleanup_on_signals, also for SIGALRM, with which ffd_process_stop ends a worker, and
   for the signals of a crash. */
void ffd_cleanup_on_crashes(void);

#endif
