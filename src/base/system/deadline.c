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
static ffd_status (*program)(ffd_error *error) = NULL;                     /* in a module: what it asks */

void ffd_deadline_ask(ffd_status (*check)(ffd_error *error))
{
    program = check;
}

const deadline *ffd_deadline_begin(deadline *own, double seconds, work_watch *watch)
{
    const deadline *const before = current;
    const double limit = seconds > 0 ? ffd_clock_seconds() + seconds : INFINITY;
    const bool is_earlier = limit < (before ? before->at : INFINITY);
    const bool watches = watch && (watch->progress || watch->cancel);
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

static void set(int *flag)
{
    __atomic_store_n(flag, 1, __ATOMIC_RELAXED);
}

/* Whether the caller has cancelled the work; asks him if it is time. */
static bool is_cancelled(work_watch *watch)
{
    if (watch->cancel && ffd_flag_is_set(watch->cancel))
        set(&watch->is_cancelled);
    if (watch->progress && watch->thread == &this_thread && !ffd_flag_is_set(&watch->is_cancelled) &&
        ffd_clock_seconds() >= watch->next) {
        if (!watch->progress(watch->user, watch->done))
            set(&watch->is_cancelled);
        watch->next = ffd_clock_seconds() + PAUSE;
    }
    return ffd_flag_is_set(&watch->is_cancelled);
}

bool ffd_deadline_passed(void)
{
    if (program)
        return program(NULL) != FFD_OK;
    return current &&
           ((current->watch && is_cancelled(current->watch)) || ffd_clock_seconds() >= current->at);
}

ffd_status ffd_deadline_check(ffd_error *error)
{
    if (program)
        return program(error);
    if (!ffd_deadline_passed())
        return FFD_OK;
    if (current->watch && ffd_flag_is_set(&current->watch->is_cancelled))
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
