#define _GNU_SOURCE /* sched_getaffinity */
#include "base/system/processors.h"
#include "base/system/cgroup.h"
#include "base/system/clock.h"
#include <limits.h>
#include <sched.h>
#include <stdatomic.h>
#include <unistd.h>

/* Returns the number of processors that are online. */
static int count_online(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > INT_MAX ? INT_MAX : (int)count;
}

#ifdef __linux__
/* A mask of more processors than Linux can be built for. */
#define MOST_SETS 64

/* Linux refuses a mask with fewer bits than it has processors. A short one takes less time. */
static int count_allowed(void)
{
    cpu_set_t sets[MOST_SETS];
    for (size_t count = 1; count <= MOST_SETS; count *= 8)
        if (sched_getaffinity(0, count * sizeof *sets, sets) == 0)
            return CPU_COUNT_S(count * sizeof *sets, sets);
    return count_online();
}
#else
static int count_allowed(void)
{
    return count_online();
}
#endif

/* Returns the limit of the control groups. Reading it takes long beside a call on a few points, but it may
   change during the life of a process. */
static int count_limit(void)
{
    static atomic_uint read_at; /* the second after the one when `known` was read; 0: never */
    static atomic_int known;
    const unsigned now = (unsigned)ffd_clock_seconds() + 1;
    if (atomic_load(&read_at) != now) {
        const uint64_t limit = ffd_cgroup_processor_limit(CGROUP_SELF);
        atomic_store(&known, limit > INT_MAX ? INT_MAX : (int)limit);
        atomic_store(&read_at, now);
    }
    return atomic_load(&known);
}

int ffd_processor_count(void)
{
    const int allowed = count_allowed(), limit = allowed > 1 ? count_limit() : 1;
    return allowed < limit ? allowed : limit;
}
