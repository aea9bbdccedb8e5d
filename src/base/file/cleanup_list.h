/* cleanup_list.h - what cleanup.h notes (cleanup.c), for the part of it that each system has: its lock and
   its handlers of signals (cleanup_signals.c). */
#ifndef FFD_BASE_FILE_CLEANUP_LIST_H
#define FFD_BASE_FILE_CLEANUP_LIST_H

/* Removes all that this process has noted. The caller holds the lock, and keeps it. Calls only what a signal
   handler may call. */
void ffd_cleanup_remove_all(void);

#endif
