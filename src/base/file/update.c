#define _XOPEN_SOURCE 700 /* realpath, pread */
#include "base/file/update.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>

struct update_file {
    int fd;
};

/* Takes ownership of the descriptor. */
static update_file *make(int fd)
{
    update_file *const file = ffd_alloc(1, sizeof *file);
    if (file)
        file->fd = fd;
    else
        close(fd);
    return file;
}

/* Opens an existing file; otherwise creates it if `makes` is true. */
static int open_or_make(const char *path, bool makes)
{
    const int flags = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    char *const target = realpath(path, NULL);
    const int fd = target                     ? open(target, flags)
                   : makes && errno == ENOENT ? open(path, flags | O_CREAT | O_EXCL, 0666)
                                              : -1;
    const int reason = errno;
    free(target);
    errno = reason;
    return fd;
}

static ffd_status open_file(const char *path, bool makes, update_file **file, ffd_error *error)
{
    struct stat info;
    const int fd = open_or_make(path, makes);
    *file = NULL;
    if (fd < 0)
        return errno == EEXIST ? ffd_fail_file(error, FFD_E_IO, path, "is a link that leads to no file")
                               : ffd_fail_errno(error, path, "cannot be written");
    ffd_status status = FFD_OK;
    if (fstat(fd, &info) != 0)
        status = ffd_fail_errno(error, path, "cannot be written");
    else if (!S_ISREG(info.st_mode))
        status = ffd_fail_file(error, FFD_E_IO, path, "is not a file");
    if (status) {
        close(fd);
        return status;
    }
    *file = make(fd);
    return *file ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_update_open(const char *path, update_file **file, ffd_error *error)
{
    return open_file(path, true, file, error);
}

ffd_status ffd_update_open_there(const char *path, update_file **file, ffd_error *error)
{
    return open_file(path, false, file, error);
}

/* Returns the offset as the type of the system; negative if it is out of range. */
static off_t offset_of(uint64_t at, size_t size)
{
    const uint64_t most = sizeof(off_t) < sizeof at ? INT32_MAX : INT64_MAX;
    return at <= most && size <= most - at ? (off_t)at : -1;
}

bool ffd_update_read(const update_file *file, uint64_t at, void *bytes, size_t size)
{
    const off_t begin = offset_of(at, size);
    size_t done = 0;
    while (begin >= 0 && done < size) {
        const ssize_t got = pread(file->fd, (char *)bytes + done, size - done, begin + (off_t)done);
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        done += got < 0 ? 0 : (size_t)got;
    }
    return begin >= 0;
}

bool ffd_update_write(update_file *file, uint64_t at, const void *bytes, size_t size)
{
    const off_t begin = offset_of(at, size);
    size_t done = 0;
    while (begin >= 0 && done < size) {
        const ssize_t put = pwrite(file->fd, (const char *)bytes + done, size - done, begin + (off_t)done);
        if (put == 0 || (put < 0 && errno != EINTR))
            return false;
        done += put < 0 ? 0 : (size_t)put;
    }
    return begin >= 0;
}

bool ffd_update_size(const update_file *file, uint64_t *size)
{
    struct stat info;
    *size = 0;
    if (fstat(file->fd, &info) != 0 || info.st_size < 0)
        return false;
    *size = (uint64_t)info.st_size;
    return true;
}

bool ffd_update_clear(update_file *file)
{
    return ftruncate(file->fd, 0) == 0;
}

void ffd_update_close(update_file **file)
{
    if (*file) {
        close((*file)->fd);
        ffd_free(*file);
    }
    *file = NULL;
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
    if (fd < 0) { /* the temporary file belongs to another run */
        ffd_free(name);
        ffd_successor_end(successor);
        return false;
    }
    successor->temporary = name;
    successor->file = make(fd);
    if (successor->file && successor->noted && stat(successor->target, &info) == 0 &&
        fchmod(fd, info.st_mode & 0777) == 0)
        return true;
    ffd_successor_end(successor);
    return false;
}

bool ffd_successor_commit(file_successor *successor, update_file **file)
{
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
    ffd_update_close(&successor->file);
    ffd_free(successor->temporary);
    ffd_free(successor->target);
    *successor = (file_successor){0};
}
