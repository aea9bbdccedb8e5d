/* process.h - workers: child processes that communicate over a channel (a socket pair; on Windows two pipes).
   A crash or a system limit that ends a worker does not affect other processes. */
#ifndef FFD_BASE_SYSTEM_PROCESS_H
#define FFD_BASE_SYSTEM_PROCESS_H

#include "base/fail.h"
#include "base/text/buffer.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct worker_process worker_process;

/* How a worker ended. */
typedef struct process_end {
    int code;       /* exit code, if no signal ended it */
    int signal;     /* 0: none */
    char text[128]; /* in words: "Segmentation fault", "exit code 3" */
    bool killed;    /* by a signal from outside: the system is out of memory, or somebody killed it */
} process_end;

/* Starts a program (NULL: this one) with two arguments, `name` as argv[0], which tells it that it is a
   worker, and `build`, by which it knows whether both understand each other. Standard error is inherited.
   Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_process_start(const char *program, const char *name, const char *build,
                             worker_process **process, ffd_error *error);
/* Sends bytes to the worker; blocks until all are sent. Returns false if the worker has ended. */
bool ffd_process_send(worker_process *process, const void *bytes, size_t size);
/* Waits until a process has sent something or has ended, until a descriptor can be read (negative: none),
   until seconds have passed (negative: no limit), or until the program is interrupted (interrupt.h). Entries
   may be NULL. */
void ffd_process_wait(worker_process *const *processes, size_t count, int input, double seconds);
/* Appends the bytes that can be read without blocking. Returns false at the end of the channel: the worker
   has ended or is about to. */
bool ffd_process_receive(worker_process *process, byte_buffer *bytes);
/* Asks the worker to end after it has removed its unfinished output. */
void ffd_process_stop(worker_process *process);
/* Ends the worker immediately (SIGKILL). */
void ffd_process_kill(worker_process *process);
/* Closes the channel, at which an idle worker ends, waits for that, and frees the object. process and
 *process may be NULL; end may be NULL. */
void ffd_process_finish(worker_process **process, process_end *end);

/* In a worker: lets the system end it when its parent process ends, if the system can do that. */
void ffd_process_follow_parent(void);
#ifdef _WIN32
/* In a worker: calls a function, which ends the process, in another thread at ffd_process_stop. */
void ffd_process_on_stop(void (*function)(void));
#endif
/* In a worker: from now on ffd_process_stop is deferred (wait), or takes effect (not wait). To be called when
   the worker has only one thread. */
void ffd_process_defer_stop(bool wait);
/* In a worker: receives the next size bytes from its parent process. Returns false at the end of the
   channel. */
bool ffd_process_take(void *bytes, size_t size);
/* In a worker: sends bytes to its parent process. Returns false if the parent has ended. */
bool ffd_process_give(const void *bytes, size_t size);

#endif
