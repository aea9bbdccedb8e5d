/* posix.h - the calls of POSIX by which files, folders and mapped memory are reached; for Windows the same
   calls with the same meaning (base/windows), for macOS the few that it lacks (base/macos). What is different
   in kind has a file of its own: NAME.c and NAME_windows.c. */
#ifndef FFD_BASE_POSIX_H
#define FFD_BASE_POSIX_H

#ifdef _WIN32
#include "base/windows/posix.h"
#else
#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __APPLE__
#include "base/macos/posix.h"
#endif

/* Names that are none of a file are those of Windows (base/windows/path_flaw.h). */
static inline const char *ffd_path_flaw(const char *path)
{
    (void)path;
    return NULL;
}
#endif

#endif
