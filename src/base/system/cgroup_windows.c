#include "base/system/cgroup.h"

/* Windows has no control groups. */
uint64_t ffd_cgroup_processor_limit(const char *process)
{
    (void)process;
    return CGROUP_UNLIMITED;
}

uint64_t ffd_cgroup_memory_limit(const char *process)
{
    (void)process;
    return CGROUP_UNLIMITED;
}
