/* deadline.h - the time by which the work of a thread has to end. Threads that it starts (thread.h) have the
   same deadline. Loops that can take long look at it. */
#ifndef FFD_BASE_SYSTEM_DEADLINE_H
#define FFD_BASE_SYSTEM_DEADLINE_H

#include "base/fail.h"
#include <stdbool.h>

typedef struct deadline {
    double at;      /* ffd_clock_seconds */
    double seconds; /* that the work may take, for the message */
} deadline;

/* Begins a deadline of the calling thread in this many seconds, unless it has an earlier one; 0: none.
   Returns the deadline before, for ffd_deadline_end. *own must stay until then. */
const deadline *ffd_deadline_begin(deadline *own, double seconds);
/* Ends the deadline. */
void ffd_deadline_end(const deadline *before);

/* Returns the deadline of the calling thread, NULL: none. */
const deadline *ffd_deadline_get(void);
/* Sets it in a thread that was started. */
void ffd_deadline_set(const deadline *shared);

/* Whether the deadline has passed. Without one it takes no time. */
bool ffd_deadline_passed(void);
/* Fails if it has passed. Errors: FFD_E_LIMIT. */
ffd_status ffd_deadline_check(ffd_error *error);
/* Returns the milliseconds until the deadline, at least 0, for poll; -1: there is none. */
int ffd_deadline_left(void);

#endif
