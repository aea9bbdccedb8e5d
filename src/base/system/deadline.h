/* deadline.h - the time by which the work of a thread has to end, and the caller who watches it and may
   cancel it. Threads that it starts (thread.h) have the same deadline. Loops that can take long look at it.
 */
#ifndef FFD_BASE_SYSTEM_DEADLINE_H
#define FFD_BASE_SYSTEM_DEADLINE_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A caller who watches the work. Set the first three, and all others to 0. */
typedef struct work_watch {
    bool (*progress)(void *user, double done); /* may be NULL; false: the work is cancelled */
    void *user;
    const int *cancel;  /* may be NULL; not 0: the work is cancelled; other threads may set it */
    const void *thread; /* which calls progress */
    double next;        /* when it is called next */
    double done;        /* fraction of the work */
    int is_cancelled;   /* atomic, as *cancel */
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

/* Whether a number that other threads may set is not 0: the public headers have no type for that. */
static inline bool ffd_flag_is_set(const int *flag)
{
    return __atomic_load_n(flag, __ATOMIC_RELAXED) != 0;
}

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
/* The same in a loop over very many things, of which this is number i: looks now and then. */
static inline bool ffd_deadline_passed_at(size_t i)
{
    return i % 8192 == 0 && ffd_deadline_passed();
}

static inline ffd_status ffd_deadline_check_at(size_t i, ffd_error *error)
{
    return i % 8192 == 0 ? ffd_deadline_check(error) : FFD_OK;
}

/* For a module (module.h), which has a copy of this: from now on it asks the program, by this function. */
void ffd_deadline_ask(ffd_status (*check)(ffd_error *error));
/* Returns the milliseconds until the deadline must be looked at, at least 0, for poll; -1: there is none. */
int ffd_deadline_left(void);

#ifdef __cplusplus
}
#endif

#endif
