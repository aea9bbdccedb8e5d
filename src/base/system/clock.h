/* clock.h - time for reports, and waiting. */
#ifndef FFD_BASE_SYSTEM_CLOCK_H
#define FFD_BASE_SYSTEM_CLOCK_H

/* Seconds from some fixed moment; never goes back. */
double ffd_clock_seconds(void);
/* Waits at least this many seconds. */
void ffd_clock_sleep(double seconds);

#endif
