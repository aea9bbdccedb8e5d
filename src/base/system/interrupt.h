/* interrupt.h - signals that ask the program to end are recorded, so that it can end in order. */
#ifndef FFD_BASE_SYSTEM_INTERRUPT_H
#define FFD_BASE_SYSTEM_INTERRUPT_H

typedef enum interrupt_request {
    INTERRUPT_NONE,
    INTERRUPT_FINISH, /* Ctrl-C, once: finish what is under way */
    INTERRUPT_STOP    /* a request to terminate, a closed terminal, or Ctrl-C again: stop at once */
} interrupt_request;

/* From now on such requests are noticed and do not end the program. */
void ffd_interrupt_watch(void);
/* The strongest so far. */
interrupt_request ffd_interrupt_requested(void);
/* A stream that can be read once there is a request; -1: there is none. For ffd_process_wait. */
int ffd_interrupt_stream(void);

/* In a worker: such requests, which can reach every program of a terminal or of a job of a cluster, are left
   to the process that started it. */
void ffd_interrupt_ignore(void);

#endif
