/* interrupt.h - records the signals that ask the program to end, so that it can end in an orderly way. */
#ifndef FFD_BASE_SYSTEM_INTERRUPT_H
#define FFD_BASE_SYSTEM_INTERRUPT_H

#include <stdbool.h>

/* From now on such requests (Ctrl-C, SIGTERM, a closed terminal) are recorded instead of ending the program.
   The program must end within a second of a request: every loop that can take longer checks for one. */
void ffd_interrupt_watch(void);
/* Returns whether there was a request. */
bool ffd_interrupt_requested(void);
/* For ffd_process_wait. */
#ifdef _WIN32
/* Returns an event that is set at the first request; NULL: none. */
void *ffd_interrupt_event(void);
#else
/* Returns a file descriptor that becomes readable at the first request; -1: none. */
int ffd_interrupt_stream(void);
#endif

/* In a worker: ignores such requests, which can reach all processes of a terminal or a cluster job; the
   parent process handles them. */
void ffd_interrupt_ignore(void);

#endif
