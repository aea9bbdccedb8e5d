#include "base/system/deadline.h"
#include "base/system/clock.h"
#include "base/system/thread_local.h"
#include <limits.h>
#include <math.h>
#include <stddef.h>

/* Seconds between two calls of a watch. */
#define PAUSE 0.1

static _Thread_local const deadline *current FFD_ALLOCATED_WITH_THREAD = NULL;
static _Thread_local const char this_thread FFD_ALLOCATED_WITH_THREAD = 0; /* its address names the thread */

const deadline *ffd_deadline_begin(deadline *own, double seconds, work_watch *watch)
{
    const deadline *const before = current;
    const double limit = seconds > 0 ? ffd_clock_seconds() + seconds : INFINITY;
    const bool is_earlier = limit < (before ? before->at : INFINITY);
    const bool watches = watch && watch->progress;
    *own = is_earlier || !before ? (deadline){.at = limit, .seconds = seconds} : *before;
    own->watch = watches ? watch : before ? before->watch : NULL;
    if (watches)
        watch->thread = &this_thread;
    if (is_earlier || watches)
        current = own;
    return before;
}

void ffd_deadline_end(const deadline *before)
{
    current = before;
}

const deadline *ffd_deadline_get(void)
{
    return current;
}

void ffd_deadline_set(const deadline *shared)
{
    current = shared;
}

void ffd_deadline_done(double done)
{
    work_watch *const watch = current ? current->watch : NULL;
    if (watch && watch->thread == &this_thread && done > watch->done)
        watch->done = done;
}

/* Whether the caller has cancelled the work; asks him if it is time. */
static bool is_cancelled(work_watch *watch)
{
    if (watch->thread == &this_thread && !atomic_load(&watch->is_cancelled) &&
        ffd_clock_seconds() >= watch->next) {
        if (!watch->progress(watch->user, watch->done))
            atomic_store(&watch->is_cancelled, true);
        watch->next = ffd_clock_seconds() + PAUSE;
    }
    return atomic_load(&watch->is_cancelled);
}

bool ffd_deadline_passed(void)
{
    return current &&
           ((current->watch && is_cancelled(current->watch)) || ffd_clock_seconds() >= current->at);
}

ffd_status ffd_deadline_check(ffd_error *error)
{
    if (!ffd_deadline_passed())
        return FFD_OK;
    if (current->watch && atomic_load(&current->watch->is_cancelled))
        return ffd_fail(error, FFD_E_CANCELLED, "the caller has ended the job");
    return ffd_fail(error, FFD_E_LIMIT, "took longer than %g %s ({timeout})", current->seconds,
                    current->seconds == 1 ? "second" : "seconds");
}

int ffd_deadline_left(void)
{
    if (!current)
        return -1;
    const double left = 1000 * (current->at - ffd_clock_seconds()),
                 most = current->watch ? 1000 * PAUSE : INT_MAX - 1;
    return left <= 0 ? 0 : left < most ? (int)left + 1 : (int)most;
}
