#define _DEFAULT_SOURCE /* flock, pread */
#include "base/file/growing.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <string.h>

struct growing_file {
    char *path;
    file_output *output; /* committed when the file is created */
    int fd;              /* descriptor of the committed file; output closes it */
};

bool ffd_growing_can(const char *path)
{
    file_stamp stamp;
    return !ffd_output_is_stream(path) && (!ffd_file_exists(path) || ffd_file_stamp(path, &stamp));
}

/* Refuses a file that another run is writing. */
static ffd_status refuse_locked(const char *path, ffd_error *error)
{
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const bool locked = fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0)
        close(fd);
    return locked ? ffd_fail_file(error, FFD_E_IO, path, "is being written by another run") : FFD_OK;
}

ffd_status ffd_growing_create(const char *path, const void *bytes, size_t size, written_files *written,
                              growing_file **file, ffd_error *error)
{
    growing_file *made = ffd_alloc_zero(1, sizeof *made);
    *file = NULL;
    if (made)
        made->path = ffd_text_copy(path);
    ffd_status status;
    TRY_END(made && made->path ? refuse_locked(path, error) : ffd_fail_memory(error));
    TRY_END(ffd_output_create(&made->output, error));
    ffd_output_record(made->output, written);
    TRY_END(ffd_output_begin(made->output, path, true, error));
    TRY_END(ffd_output_write(made->output, bytes, size, error));
    made->fd = ffd_output_keep_open(made->output);
    TRY_END(ffd_output_commit(made->output, error));
end:
    if (status)
        ffd_growing_close(&made);
    *file = made;
    return status;
}

static ffd_status fail_errno(const growing_file *file, const char *what, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_IO, file->path, "%s: %s", what, strerror(errno));
}

ffd_status ffd_growing_write(growing_file *file, uint64_t at, const void *bytes, size_t size,
                             ffd_error *error)
{
    for (size_t done = 0; done < size;) {
        const ssize_t written = pwrite(file->fd, (const char *)bytes + done, size - done, (off_t)(at + done));
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0) {
            const ffd_status status = fail_errno(file, "cannot be written", error);
            const int cut = ftruncate(file->fd, (off_t)at);
            (void)cut;
            return status;
        }
        done += (size_t)written;
    }
    return FFD_OK;
}

ffd_status ffd_growing_read(const growing_file *file, uint64_t at, void *bytes, size_t size, ffd_error *error)
{
    for (size_t done = 0; done < size;) {
        const ssize_t count = pread(file->fd, (char *)bytes + done, size - done, (off_t)(at + done));
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return fail_errno(file, "cannot be read", error);
        if (count == 0)
            return ffd_fail_file(error, FFD_E_IO, file->path, "has become shorter while it was written");
        done += (size_t)count;
    }
    return FFD_OK;
}

void ffd_growing_close(growing_file **file)
{
    if (!file || !*file)
        return;
    ffd_output_destroy(&(*file)->output);
    ffd_free((*file)->path);
    ffd_free(*file);
    *file = NULL;
}
