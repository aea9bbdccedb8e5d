/* process.h - workers: processes of this program, reached over a channel. What ends a worker, be it a crash
   or a limit of the system, ends nothing else. */
#ifndef FFD_BASE_SYSTEM_PROCESS_H
#define FFD_BASE_SYSTEM_PROCESS_H

#include "base/fail.h"
#include "base/text/buffer.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct worker_process worker_process;

/* How a worker has ended. */
typedef struct process_end {
    int code;       /* its exit code, where no signal ended it */
    int signal;     /* 0: none */
    char text[128]; /* in words: "Segmentation fault", "exit code 3" */
    bool killed;    /* by a signal that no process sends itself: from the system, out of memory, or by hand */
} process_end;

/* Starts this program with `name` as its argument 0, and no other arguments: by that it knows that it is a
   worker. Standard error is shared. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_process_start(const char *name, worker_process **process, ffd_error *error);
/* Sends bytes to the worker, and waits until it has taken them. Returns false if it has ended. */
bool ffd_process_send(worker_process *process, const void *bytes, size_t size);
/* Waits until one of the processes has something to be read or has ended, or seconds have gone by (below 0:
   without limit), or the program was interrupted (interrupt.h). Entries may be NULL. */
void ffd_process_wait(worker_process *const *processes, size_t count, double seconds);
/* Appends the bytes that can be read without waiting. Returns false at the end of the channel: the
   worker has ended, or will. */
bool ffd_process_receive(worker_process *process, byte_buffer *bytes);
/* Ends the worker after it has removed what it was writing. */
void ffd_process_stop(worker_process *process);
/* Ends the worker at once. */
void ffd_process_kill(worker_process *process);
/* Closes the channel, at which an idle worker ends, waits for its end, and frees. NULL and pointers to NULL
   are allowed; end may be NULL. */
void ffd_process_finish(worker_process **process, process_end *end);

/* In a worker: ends it when its parent process ends, in whatever way, where the system can do that. */
void ffd_process_follow_parent(void);
/* In a worker: from now on ffd_process_stop waits, or does not wait any more. One thread calls this; others
   must have ended. */
void ffd_process_defer_stop(bool wait);
/* In a worker: receives the next size bytes from its parent process. Returns false if there are no more. */
bool ffd_process_take(void *bytes, size_t size);
/* In a worker: sends bytes to its parent process. Returns false if that has ended. */
bool ffd_process_give(const void *bytes, size_t size);

#endif
