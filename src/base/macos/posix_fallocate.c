/* posix_fallocate.c - a file that grows with its space on the disk. */
#include "base/macos/posix.h"
#include <errno.h>
#include <unistd.h>

int ffd_macos_fallocate(int fd, off_t at, off_t size)
{
    struct stat info;
    if (fstat(fd, &info) != 0)
        return errno;
    if (at + size <= info.st_size)
        return 0;
    /* Counted from the end of what the file has on the disk, which is no less than its length. */
    fstore_t more = {
        .fst_flags = F_ALLOCATEALL, .fst_posmode = F_PEOFPOSMODE, .fst_length = at + size - info.st_size};
    return fcntl(fd, F_PREALLOCATE, &more) == -1 || ftruncate(fd, at + size) != 0 ? errno : 0;
}
