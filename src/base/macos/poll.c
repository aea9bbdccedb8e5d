/* poll.c - waits for terminals and other devices too. */
#include "base/macos/posix.h"
#include <stdbool.h>
#include <stddef.h>
#include <sys/select.h>

/* Whether select is to wait, which knows devices, but only descriptors below FD_SETSIZE. */
static bool needs_select(const struct pollfd *set, nfds_t count)
{
    struct stat info;
    bool has_device = false;
    for (nfds_t i = 0; i < count; i++) {
        if (set[i].fd >= FD_SETSIZE)
            return false;
        has_device = has_device || (fstat(set[i].fd, &info) == 0 && S_ISCHR(info.st_mode));
    }
    return has_device;
}

int ffd_macos_poll(struct pollfd *set, nfds_t count, int milliseconds)
{
    struct timeval time = {.tv_sec = milliseconds / 1000, .tv_usec = milliseconds % 1000 * 1000};
    fd_set ready;
    int most = -1;
    if (!needs_select(set, count))
        return (poll)(set, count, milliseconds);
    FD_ZERO(&ready);
    for (nfds_t i = 0; i < count; i++) {
        FD_SET(set[i].fd, &ready);
        most = set[i].fd > most ? set[i].fd : most;
    }
    const int found = select(most + 1, &ready, NULL, NULL, milliseconds < 0 ? NULL : &time);
    for (nfds_t i = 0; i < count; i++)
        set[i].revents = found > 0 && FD_ISSET(set[i].fd, &ready) ? POLLIN : 0;
    return found;
}
