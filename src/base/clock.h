/* clock.h - time for reports. */
#ifndef FFD_BASE_CLOCK_H
#define FFD_BASE_CLOCK_H

/* Seconds from some fixed moment; never goes back. */
double ffd_clock_seconds(void);

#endif
