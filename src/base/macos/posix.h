/* posix.h - calls that base/posix.h names, and that macOS names otherwise, or lacks: poll.c,
   posix_fallocate.c. Compiled and linked, never run on a Mac. */
#ifndef FFD_BASE_MACOS_POSIX_H
#define FFD_BASE_MACOS_POSIX_H

#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <sys/stat.h>

#define st_mtim st_mtimespec
#define st_ctim st_ctimespec

#define RENAME_NOREPLACE RENAME_EXCL
#define renameat2(from_folder, from, to_folder, to, flags)                                                   \
    renameatx_np(from_folder, from, to_folder, to, flags)

#define posix_fallocate(fd, at, size) ffd_macos_fallocate(fd, at, size)
#define poll(set, count, milliseconds) ffd_macos_poll(set, count, milliseconds)

/* Makes a file longer, with space on the disk for what is new. */
int ffd_macos_fallocate(int fd, off_t at, off_t size);
/* Waits for devices too, terminals above all, which poll itself calls invalid at once. */
int ffd_macos_poll(struct pollfd *set, nfds_t count, int milliseconds);

#endif
