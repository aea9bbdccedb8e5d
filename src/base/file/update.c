#define _XOPEN_SOURCE 700 /* realpath */
#include "base/file/update.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/memory/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Opens the file that is there, else makes it. */
static int open_or_make(const char *path)
{
    const int flags = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    char *const target = realpath(path, NULL);
    const int fd = target            ? open(target, flags)
                   : errno == ENOENT ? open(path, flags | O_CREAT | O_EXCL, 0666)
                                     : -1;
    const int reason = errno;
    free(target);
    errno = reason;
    return fd;
}

ffd_status ffd_update_open(const char *path, FILE **file, ffd_error *error)
{
    struct stat info;
    const int fd = open_or_make(path);
    *file = NULL;
    if (fd < 0)
        return errno == EEXIST ? ffd_fail_file(error, FFD_E_IO, path, "is a link that leads to no file")
                               : ffd_fail_errno(error, path, "cannot be written");
    ffd_status status = FFD_OK;
    if (fstat(fd, &info) != 0)
        status = ffd_fail_errno(error, path, "cannot be written");
    else if (!S_ISREG(info.st_mode))
        status = ffd_fail_file(error, FFD_E_IO, path, "is not a file");
    else if (!(*file = fdopen(fd, "r+b")))
        status = ffd_fail_errno(error, path, "cannot be written");
    if (status)
        close(fd);
    return status;
}

bool ffd_update_clear(FILE *file)
{
    rewind(file);
    return ftruncate(fileno(file), 0) == 0;
}

bool ffd_successor_begin(file_successor *successor, const char *path)
{
    struct stat info;
    char *const target = realpath(path, NULL);
    *successor = (file_successor){.target = target ? ffd_text_copy(target) : NULL};
    free(target);
    char *const name = successor->target ? ffd_temporary_name(successor->target) : NULL;
    ffd_cleanup_hold();
    const int fd = name ? ffd_temporary_open(name) : -1;
    successor->noted = fd < 0 ? NULL : ffd_cleanup_note(name);
    ffd_cleanup_release();
    if (fd < 0) { /* the name is not ours */
        ffd_free(name);
        ffd_successor_end(successor);
        return false;
    }
    successor->temporary = name;
    if (successor->noted && stat(successor->target, &info) == 0 && fchmod(fd, info.st_mode & 0777) == 0)
        successor->file = fdopen(fd, "w+b");
    if (successor->file)
        return true;
    close(fd);
    ffd_successor_end(successor);
    return false;
}

bool ffd_successor_commit(file_successor *successor, FILE **file)
{
    if (fflush(successor->file) != 0)
        return false;
    ffd_cleanup_hold();
    const bool placed = ffd_place(successor->temporary, successor->target, true) == 0;
    if (placed)
        ffd_cleanup_strike(&successor->noted);
    ffd_cleanup_release();
    if (!placed)
        return false;
    *file = successor->file;
    successor->file = NULL;
    ffd_free(successor->temporary);
    successor->temporary = NULL;
    return true;
}

void ffd_successor_end(file_successor *successor)
{
    ffd_cleanup_hold();
    if (successor->temporary)
        unlink(successor->temporary);
    ffd_cleanup_strike(&successor->noted);
    ffd_cleanup_release();
    if (successor->file)
        fclose(successor->file);
    ffd_free(successor->temporary);
    ffd_free(successor->target);
    *successor = (file_successor){0};
}
