/* null_device.h - a descriptor that gives nothing and takes nothing of use. */
#ifndef FFD_BASE_SYSTEM_NULL_DEVICE_H
#define FFD_BASE_SYSTEM_NULL_DEVICE_H

#include <stdbool.h>

/* Opens /dev/null for reading and writing (is_written), or for reading only. Where there is no such file, as
   in a root without /dev, returns the reading end of a pipe that nobody writes to: reading finds the end,
   writing fails. Returns -1 and sets errno after a failure. */
int ffd_null_open(bool is_written);

#endif
