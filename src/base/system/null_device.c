#include "base/system/null_device.h"
#include <errno.h>
#include <fcntl.h>
#include <ffd/program.h>
#include <unistd.h>

int ffd_null_open(bool is_written)
{
    const int null = open("/dev/null", (is_written ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    int ends[2];
    if (null >= 0 || (errno != ENOENT && errno != ENOTDIR) || pipe(ends) != 0)
        return null;
    close(ends[1]);
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    return ends[0];
}

void ffd_occupy_closed_streams(void)
{
    int null;
    do
        null = ffd_null_open(false);
    while (null >= 0 && null <= STDERR_FILENO);
    if (null >= 0)
        close(null);
}
