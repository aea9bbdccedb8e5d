/* interrupt.h - signals that ask the program to end are recorded, so that it can end in order. */
#ifndef FFD_BASE_SYSTEM_INTERRUPT_H
#define FFD_BASE_SYSTEM_INTERRUPT_H

#include <stdbool.h>

/* From now on such requests (Ctrl-C, SIGTERM, a closed terminal) are noticed and do not end the program,
   which must then end within a second: every loop that can take longer looks whether there was one. */
void ffd_interrupt_watch(void);
/* Whether there was a request. */
bool ffd_interrupt_requested(void);
/* A stream that can be read once there is a request; -1: there is none. For ffd_process_wait. */
int ffd_interrupt_stream(void);

/* In a worker: such requests, which can reach every program of a terminal or of a job of a cluster, are left
   to the process that started it. */
void ffd_interrupt_ignore(void);

#endif
