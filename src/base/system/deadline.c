#include "base/system/deadline.h"
#include "base/system/clock.h"
#include <limits.h>
#include <stddef.h>

static _Thread_local const deadline *current = NULL;

const deadline *ffd_deadline_begin(deadline *own, double seconds)
{
    const deadline *const before = current;
    own->at = ffd_clock_seconds() + seconds;
    own->seconds = seconds;
    if (seconds > 0 && (!before || own->at < before->at))
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

bool ffd_deadline_passed(void)
{
    return current && ffd_clock_seconds() >= current->at;
}

ffd_status ffd_deadline_check(ffd_error *error)
{
    return ffd_deadline_passed() ? ffd_fail(error, FFD_E_LIMIT, "took longer than %g %s ({timeout})",
                                            current->seconds, current->seconds == 1 ? "second" : "seconds")
                                 : FFD_OK;
}

int ffd_deadline_left(void)
{
    if (!current)
        return -1;
    const double left = 1000 * (current->at - ffd_clock_seconds());
    return left <= 0 ? 0 : left < INT_MAX - 1 ? (int)left + 1 : INT_MAX;
}
