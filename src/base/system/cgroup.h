/* cgroup.h - the limits of the control groups (cgroups of Linux, versions 1 and 2) that the process is in: of
   its own and of all above it, as far as they are visible. */
#ifndef FFD_BASE_SYSTEM_CGROUP_H
#define FFD_BASE_SYSTEM_CGROUP_H

#include "base/system/cgroup_text.h"

/* The folder in which Linux describes the calling process, for the functions below. */
#define CGROUP_SELF "/proc/self"

/* Returns the least limit of processor time, in processors, rounded up. CGROUP_UNLIMITED: none is known; so
   on other systems. Allocates nothing through base/memory. */
uint64_t ffd_cgroup_processor_limit(const char *process);
/* Returns the least limit of memory in bytes, likewise. */
uint64_t ffd_cgroup_memory_limit(const char *process);

#endif
