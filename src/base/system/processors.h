/* processors.h - how many processors the process may use. */
#ifndef FFD_BASE_SYSTEM_PROCESSORS_H
#define FFD_BASE_SYSTEM_PROCESSORS_H

/* Returns the number of processors that the calling thread, and threads that it starts, may use; at least 1.
   That is the number in its affinity mask, which it asks for each time, but at most the processor time that
   its control groups allow (cgroup.h), which it reads once a second. Thread-safe. */
int ffd_processor_count(void);

#endif
