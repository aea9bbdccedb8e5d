#define _DEFAULT_SOURCE /* flock, realpath */
#include "base/file/output.h"
#include "base/file/cleanup.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/file/written_files.h"
#include "base/memory/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes that are held back until they are worth a call of the system. */
#define BLOCK ((size_t)1 << 16)

typedef struct output_file {
    char *target;    /* where it shall appear; links are followed beforehand */
    char *temporary; /* NULL where bytes go straight to the target: standard output, devices */
    cleanup_entry *noted;
    int fd; /* -1 when closed */
    bool committed, remove_first;
} output_file;

typedef struct output_folder {
    char *path;
    size_t made; /* as ffd_folder_make says it */
    cleanup_entry *noted;
} output_folder;

struct file_output {
    output_file *files;
    size_t count, capacity;
    output_folder *folders; /* made for the files */
    size_t folder_count, folder_capacity;
    bool committed, keeps_equal;
    bool was_busy;        /* the target of the file that was to be begun last */
    unsigned char *block; /* bytes of the last file that are not yet written */
    size_t filled;
    written_files *written; /* or NULL */
};

static ffd_status fail_errno(ffd_error *error, const char *file, const char *what)
{
    const int reason = errno;
    return ffd_fail_file(error, reason == ENOMEM ? FFD_E_MEMORY : FFD_E_IO, file, "%s: %s", what,
                         strerror(reason));
}

ffd_status ffd_output_create(file_output **output, ffd_error *error)
{
    *output = ffd_alloc_zero(1, sizeof **output);
    if (*output)
        (*output)->block = ffd_alloc(BLOCK, 1);
    if (*output && (*output)->block)
        return FFD_OK;
    ffd_output_destroy(output);
    return ffd_fail_memory(error);
}

void ffd_output_record(file_output *output, written_files *written)
{
    output->written = written;
}

static ffd_status refuse_written(const file_output *output, const char *path, ffd_error *error)
{
    if (!output->written || !ffd_written_holds(output->written, path))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_EXISTS, path,
                         "was written by this run already, under this name or another");
}

/* No target may be one of the record's, also none that has come to be since it was begun. */
static ffd_status refuse_recorded(const file_output *output, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < output->count && !status; i++)
        if (output->files[i].temporary)
            status = refuse_written(output, output->files[i].target, error);
    return status;
}

/* Before the renames, so that nothing is written that the record does not hold: a file stays the same one
   when it gets another name. */
static ffd_status record_files(const file_output *output, bool stays, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < output->count && output->written && !status; i++) {
        const output_file *const file = &output->files[i];
        file_stamp stamp;
        if (!file->temporary)
            continue;
        if (!ffd_file_stamp(stays ? file->target : file->temporary, &stamp))
            return fail_errno(error, file->target, "cannot be written");
        status = ffd_written_add(output->written, &stamp, file->target, error);
    }
    return status;
}

/* The descriptor of a stream; -1 for other paths. A stream that was led into a file is written like any
   other, and not replaced under that file's name. */
static int stream_of(const char *path)
{
    static const char *const names[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *number = path + strlen(names[i]);
        if (strncmp(path, names[i], strlen(names[i])) == 0 && *number && strlen(number) < 9 &&
            number[strspn(number, "0123456789")] == 0)
            return atoi(number);
    }
    return -1;
}

bool ffd_output_is_stream(const char *path)
{
    return stream_of(path) >= 0;
}

/* The name of a target in messages. */
static const char *shown(const char *path)
{
    return stream_of(path) == STDOUT_FILENO ? "standard output" : path;
}

static ffd_status check_target(const char *path, bool force, struct stat *info, bool *exists,
                               ffd_error *error)
{
    *exists = stat(path, info) == 0;
    if (!*exists) {
        if (errno != ENOENT)
            return fail_errno(error, path, "cannot be written");
        return FFD_OK;
    }
    if (S_ISDIR(info->st_mode))
        return ffd_fail_file(error, FFD_E_IO, path, "is a folder");
    if (S_ISREG(info->st_mode) && !force)
        return ffd_fail_file(error, FFD_E_EXISTS, path, "exists already (--force overwrites it)");
    return FFD_OK;
}

ffd_status ffd_output_check(const char *path, bool force, ffd_error *error)
{
    struct stat info;
    bool exists;
    if (ffd_output_is_stream(path))
        return FFD_OK;
    const ffd_status status = check_target(path, force, &info, &exists, error);
    if (status || exists)
        return status;
    char *folder = ffd_path_folder(path);
    if (!folder)
        return ffd_fail_memory(error);
    ffd_status result = FFD_OK;
    if (stat(folder, &info) != 0 || !S_ISDIR(info.st_mode))
        result = ffd_fail_file(error, FFD_E_IO, path, "cannot be written: there is no folder \"%s\"", folder);
    ffd_free(folder);
    return result;
}

/* *busy: it failed because another run is writing the target. */
static ffd_status open_beside(output_file *file, const char *path, const struct stat *old, bool *busy,
                              ffd_error *error)
{
    file->temporary = ffd_temporary_name(file->target);
    if (!file->temporary)
        return ffd_fail_memory(error);
    ffd_cleanup_hold();
    file->fd = ffd_temporary_open(file->temporary);
    const int reason = errno;
    file->noted = file->fd < 0 ? NULL : ffd_cleanup_note(file->temporary);
    ffd_cleanup_release();
    if (file->fd >= 0 && !file->noted)
        return ffd_fail_memory(error);
    if (file->fd < 0) {
        ffd_free(file->temporary); /* not ours to remove */
        file->temporary = NULL;
        *busy = reason == EBUSY;
        if (*busy)
            return ffd_fail_file(error, FFD_E_IO, path, "is being written by another run");
        errno = reason;
        return fail_errno(error, path, "cannot be written");
    }
    /* Only root can give a file away; for others it is theirs already, or must stay so. */
    if (old && (old->st_uid != geteuid() || old->st_gid != getegid())) {
        const int given = fchown(file->fd, old->st_uid, old->st_gid);
        (void)given;
    }
    if (old && fchmod(file->fd, old->st_mode & 0777) != 0)
        return fail_errno(error, path, "its permissions cannot be kept");
    return FFD_OK;
}

static ffd_status write_all(const output_file *file, const unsigned char *bytes, size_t size,
                            ffd_error *error)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t written = write(file->fd, bytes + done, size - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return fail_errno(error, shown(file->target), "cannot be written");
        done += (size_t)written;
    }
    return FFD_OK;
}

static ffd_status flush(file_output *output, ffd_error *error)
{
    if (output->count == 0)
        return FFD_OK;
    const ffd_status status =
        write_all(&output->files[output->count - 1], output->block, output->filled, error);
    if (!status)
        output->filled = 0;
    return status;
}

ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error)
{
    output->was_busy = false;
    ffd_status status = flush(output, error);
    if (status)
        return status;
    if (!ffd_grow((void **)&output->files, &output->capacity, output->count + 1, sizeof *output->files))
        return ffd_fail_memory(error);
    output_file *file = &output->files[output->count];
    *file = (output_file){.fd = -1};

    struct stat info;
    bool exists = false;
    if (!ffd_output_is_stream(path)) {
        status = check_target(path, force, &info, &exists, error);
        if (status)
            return status;
    }
    char *resolved = exists && S_ISREG(info.st_mode) ? realpath(path, NULL) : NULL;
    file->target = ffd_text_copy(resolved ? resolved : path);
    free(resolved);
    if (!file->target)
        return ffd_fail_memory(error);
    output->count++;

    if (ffd_output_is_stream(path)) {
        file->fd = dup(stream_of(path));
        return file->fd < 0 ? fail_errno(error, shown(path), "cannot be written") : FFD_OK;
    }
    status = exists ? refuse_written(output, path, error) : FFD_OK;
    if (status)
        return status;
    if (exists && !S_ISREG(info.st_mode)) {
        file->fd = open(path, O_WRONLY | O_CLOEXEC);
        return file->fd < 0 ? fail_errno(error, path, "cannot be written") : FFD_OK;
    }
    status = open_beside(file, path, exists ? &info : NULL, &output->was_busy, error);
    if (status && file->fd < 0) { /* as if it had not been begun */
        ffd_free(file->target);
        output->count--;
    }
    return status;
}

ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error)
{
    if (!ffd_grow((void **)&output->folders, &output->folder_capacity, output->folder_count + 1,
                  sizeof *output->folders))
        return ffd_fail_memory(error);
    output_folder *folder = &output->folders[output->folder_count];
    *folder = (output_folder){.path = ffd_text_copy(path)};
    if (!folder->path)
        return ffd_fail_memory(error);
    output->folder_count++;
    ffd_cleanup_hold();
    ffd_status status = ffd_folder_make(path, &folder->made, error);
    if (folder->made) {
        folder->noted = ffd_cleanup_note_folder(path, folder->made);
        if (!folder->noted && !status)
            status = ffd_fail_memory(error);
    }
    ffd_cleanup_release();
    return status;
}

ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error)
{
    const ffd_status status = size > BLOCK - output->filled ? flush(output, error) : FFD_OK;
    if (status)
        return status;
    if (size >= BLOCK)
        return write_all(&output->files[output->count - 1], bytes, size, error);
    if (size > 0)
        memcpy(output->block + output->filled, bytes, size);
    output->filled += size;
    return FFD_OK;
}

void ffd_output_remove_first(file_output *output)
{
    output->files[output->count - 1].remove_first = true;
}

/* Some file systems report a full disk only when a file is closed. Closing a twin asks them, while the old
   target is still there, and does not give up the lock. */
static ffd_status check_written(const file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->count; i++) {
        const output_file *file = &output->files[i];
        const int twin = file->temporary ? dup(file->fd) : -1;
        if (file->temporary && (twin < 0 || close(twin) != 0))
            return fail_errno(error, file->target, "cannot be written");
    }
    return FFD_OK;
}

void ffd_output_keep_equal(file_output *output)
{
    output->keeps_equal = true;
}

/* Whether a target has the bytes already that were written for it. One that cannot be read has not. */
static bool is_equal(const output_file *file)
{
    file_input bytes;
    bool same = false;
    if (!file->temporary || ffd_file_load(file->temporary, &bytes, NULL))
        return false;
    if (ffd_file_compare(file->target, &bytes, &same, NULL))
        same = false;
    ffd_file_unload(&bytes);
    return same;
}

static bool is_to_stay(const file_output *output)
{
    for (size_t i = 0; i < output->count; i++)
        if (!is_equal(&output->files[i]))
            return false;
    return true;
}

/* Takes the temporary file's name away: to the target or, where that stays, altogether. */
static ffd_status settle_file(output_file *file, bool stays, ffd_error *error)
{
    if (file->temporary && (stays ? unlink(file->temporary) : rename(file->temporary, file->target)) != 0)
        return fail_errno(error, file->target, "cannot be written");
    file->committed = true;
    ffd_cleanup_strike(&file->noted);
    /* Closing gives up the lock: only now may another run take the name. */
    const int fd = file->fd;
    file->fd = -1;
    return close(fd) == 0 ? FFD_OK : fail_errno(error, file->target, "cannot be written");
}

static ffd_status settle_all(file_output *output, bool stays, ffd_error *error)
{
    for (size_t i = 0; i < output->count && !stays; i++) {
        output_file *file = &output->files[i];
        if (file->remove_first && file->temporary && unlink(file->target) != 0 && errno != ENOENT)
            return fail_errno(error, file->target, "cannot be replaced");
    }
    for (size_t i = 0; i < output->count; i++) {
        const ffd_status status = settle_file(&output->files[i], stays, error);
        if (status)
            return status;
    }
    for (size_t i = 0; i < output->folder_count; i++)
        ffd_cleanup_strike(&output->folders[i].noted);
    output->committed = true;
    return FFD_OK;
}

ffd_status ffd_output_commit(file_output *output, ffd_error *error)
{
    ffd_status status = flush(output, error);
    if (!status)
        status = refuse_recorded(output, error);
    if (!status)
        status = check_written(output, error);
    const bool stays = !status && output->keeps_equal && is_to_stay(output);
    if (!status)
        status = record_files(output, stays, error);
    if (status)
        return status;
    /* A signal comes before all renames or after them: a set is not torn apart. */
    ffd_cleanup_hold();
    status = settle_all(output, stays, error);
    ffd_cleanup_release();
    return status;
}

bool ffd_output_was_busy(const file_output *output)
{
    return output->was_busy;
}

void ffd_output_destroy(file_output **output)
{
    if (!output || !*output)
        return;
    ffd_cleanup_hold();
    for (size_t i = 0; i < (*output)->count; i++) {
        output_file *file = &(*output)->files[i];
        if (file->temporary && !file->committed)
            unlink(file->temporary);
        ffd_cleanup_strike(&file->noted);
        if (file->fd >= 0)
            close(file->fd);
        ffd_free(file->temporary);
        ffd_free(file->target);
    }
    for (size_t i = (*output)->folder_count; i-- > 0;) {
        if (!(*output)->committed)
            ffd_folder_unmake((*output)->folders[i].path, (*output)->folders[i].made);
        ffd_cleanup_strike(&(*output)->folders[i].noted);
        ffd_free((*output)->folders[i].path);
    }
    ffd_cleanup_release();
    ffd_free((*output)->folders);
    ffd_free((*output)->files);
    ffd_free((*output)->block);
    ffd_free(*output);
    *output = NULL;
}
