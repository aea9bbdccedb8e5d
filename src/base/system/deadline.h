/* deadline.h - the time by which the work of a thread has to end, and the caller who watches it and may
   cancel it. Threads that it starts (thread.h) have the same deadline. Loops that can take long look at it.
 */
#ifndef FFD_BASE_SYSTEM_DEADLINE_H
#define FFD_BASE_SYSTEM_DEADLINE_H

#include "base/fail.h"
#include <stdatomic.h>
#include <stdbool.h>

/* A caller who watches the work. Set progress and user, and all others to 0. */
typedef struct work_watch {
    bool (*progress)(void *user, double done); /* NULL: nobody watches; false: the work is cancelled */
    void *user;
    const void *thread; /* which calls progress */
    double next;        /* when it is called next */
    double done;        /* fraction of the work */
    atomic_bool is_cancelled;
} work_watch;

typedef struct deadline {
    double at;         /* ffd_clock_seconds; infinite: never */
    double seconds;    /* that the work may take, for the message */
    work_watch *watch; /* NULL: none */
} deadline;

/* Begins a deadline of the calling thread in this many seconds, unless it has an earlier one; 0: none. watch:
   the caller, or NULL; this thread calls him from now on. Returns the deadline before, for ffd_deadline_end.
   *own and *watch must stay until then. */
const deadline *ffd_deadline_begin(deadline *own, double seconds, work_watch *watch);
/* Ends the deadline. */
void ffd_deadline_end(const deadline *before);

/* Returns the deadline of the calling thread, NULL: none. */
const deadline *ffd_deadline_get(void);
/* Sets it in a thread that was started. */
void ffd_deadline_set(const deadline *shared);

/* Tells the watch how much of the work is done, if this is its thread. Fractions that fall are ignored. */
void ffd_deadline_done(double done);
/* Whether the deadline has passed, or the work is cancelled. Calls the watch now and then. Without a deadline
   it takes no time. */
bool ffd_deadline_passed(void);
/* Fails if it has. Errors: FFD_E_LIMIT, FFD_E_CANCELLED. */
ffd_status ffd_deadline_check(ffd_error *error);
/* Returns the milliseconds until the deadline must be looked at, at least 0, for poll; -1: there is none. */
int ffd_deadline_left(void);

#endif
