/* lock.c - flock() of the program for npm: emscripten's pretends to succeed, and two runs would take each
   other's unfinished files for leftovers. */
#include <errno.h>

int __wrap_flock(int fd, int operation);

int __wrap_flock(int fd, int operation)
{
    (void)fd;
    (void)operation;
    errno = ENOSYS;
    return -1;
}
