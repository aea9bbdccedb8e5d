/* clock.h - time for reports, and waiting. */
#ifndef FFD_BASE_SYSTEM_CLOCK_H
#define FFD_BASE_SYSTEM_CLOCK_H

/* Returns seconds since a fixed but unknown time (monotonic). */
double ffd_clock_seconds(void);
/* Sleeps for at least this many seconds. */
void ffd_clock_sleep(double seconds);

#endif
