#define _DEFAULT_SOURCE /* mkstemp */
#include "base/file/unnamed_file.h"
#include "base/file/cleanup.h"
#include "base/posix.h"
#include <stdio.h>

int ffd_unnamed_file(void)
{
    const char *folder = getenv("TMPDIR");
    char path[4096];
    const int length =
        snprintf(path, sizeof path, "%s/ffd-spill-XXXXXX", folder && *folder ? folder : "/var/tmp");
    if (length < 0 || (size_t)length >= sizeof path)
        return -1;
    ffd_cleanup_hold(); /* so that a signal cannot leave a file with a name */
    const int file = mkstemp(path);
    if (file >= 0) {
        unlink(path);
        fcntl(file, F_SETFD, FD_CLOEXEC);
    }
    ffd_cleanup_release();
    return file;
}
