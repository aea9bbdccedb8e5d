#include "base/posix.h"
#include "base/system/null_device.h"
#include <ffd/program.h>

int ffd_null_open(bool is_written)
{
    return open("/dev/null", is_written ? O_RDWR : O_RDONLY);
}

/* What goes through standard streams is not translated either. */
void ffd_occupy_closed_streams(void)
{
    int null;
    do
        null = ffd_null_open(true);
    while (null >= 0 && null <= STDERR_FILENO);
    if (null >= 0)
        close(null);
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        _setmode(fd, O_BINARY);
}
