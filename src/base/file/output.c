#define _GNU_SOURCE /* realpath, statx */
#include "base/file/output.h"
#include "base/file/cleanup.h"
#include "base/file/file_set.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/file/written_files.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/deadline.h"
#include "base/text/buffer.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Size of the write buffer. */
#define BLOCK ((size_t)1 << 16)

/* How often folders are made again that other runs remove. */
#define FOLDER_TRIES 20

typedef struct output_file {
    char *target;    /* final path, with symbolic links resolved */
    char *temporary; /* NULL if bytes go directly to the target: standard output, devices */
    cleanup_entry *noted;
    int fd; /* -1 when closed */
    bool force, committed;
    bool stays_open;   /* also after the commit */
    byte_buffer bytes; /* for the sink */
} output_file;

typedef struct output_folder {
    char *path;
    size_t made; /* as ffd_folder_make sets it */
    cleanup_entry *noted;
} output_folder;

struct file_output {
    output_file *files;
    size_t count, capacity;
    output_folder *folders; /* made for the files */
    size_t folder_count, folder_capacity;
    bool committed, keeps_equal;
    bool was_busy;        /* another run is writing the target of the last ffd_output_begin */
    unsigned char *block; /* bytes of the last file that are not written yet */
    size_t filled;
    written_files *written; /* may be NULL */
    hash_stream *hash;      /* hash of the first file; NULL: not requested */
    ffd_sink_function sink; /* NULL: in the file system */
    void *sink_user;
};

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

void ffd_output_redirect(file_output *output, ffd_sink_function sink, void *user)
{
    output->sink = sink;
    output->sink_user = user;
}

void ffd_output_hash(file_output *output)
{
    output->hash = ffd_hash_stream_create(); /* NULL if memory runs out: there is no hash then */
}

bool ffd_output_hash_value(const file_output *output, hash128 *hash)
{
    const bool is_known = output->hash && output->count == 1 && output->files[0].temporary;
    if (is_known)
        *hash = ffd_hash_stream_value(output->hash);
    return is_known;
}

static ffd_status refuse_written(const file_output *output, const char *path, ffd_error *error)
{
    if (!output->written || !ffd_written_holds(output->written, path))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_EXISTS, path,
                         "was written by this run already, under this name or another");
}

/* Refuses targets that are among the written files, also if they became so after ffd_output_begin. */
static ffd_status refuse_recorded(const file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->count; i++)
        if (output->files[i].temporary)
            TRY(refuse_written(output, output->files[i].target, error));
    return FFD_OK;
}

/* Records the files before they are renamed, so that no file is missing in the record: a rename does not
   change a file's identity. */
static ffd_status record_files(const file_output *output, bool stays, ffd_error *error)
{
    for (size_t i = 0; i < output->count && output->written; i++) {
        const output_file *const file = &output->files[i];
        file_stamp stamp;
        if (!file->temporary)
            continue;
        if (!ffd_file_stamp(stays ? file->target : file->temporary, &stamp))
            return ffd_fail_errno(error, file->target, "cannot be written");
        TRY(ffd_written_add(output->written, &stamp, file->target, error));
    }
    return FFD_OK;
}

/* Returns the descriptor of a stream; -1 for other paths. A stream that is redirected to a file is written
   to, and the file is not replaced. */
static int stream_of(const char *path)
{
    static const char *const names[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strncmp(path, names[i], strlen(names[i])) != 0)
            continue;
        const char *const number = path + strlen(names[i]);
        if (*number && strlen(number) < 9 && number[strspn(number, "0123456789")] == 0)
            return atoi(number);
    }
    return -1;
}

bool ffd_output_is_stream(const char *path)
{
    return stream_of(path) >= 0;
}

ffd_status ffd_file_check_name(const char *name, ffd_error *error)
{
    const char *const last = ffd_path_name(name);
    return *last && strcmp(last, ".") != 0 && strcmp(last, "..") != 0 && !ffd_file_is_stream(name) &&
                   !ffd_output_is_stream(name)
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "\"%s\" is no name for a file", name);
}

/* Returns the name of a target for messages. */
static const char *shown(const char *path)
{
    return stream_of(path) == STDOUT_FILENO ? "standard output" : path;
}

/* Refuses targets that cannot hold an output, or block while they are opened. */
static ffd_status refuse_special(const struct stat *info, const char *path, ffd_error *error)
{
    if (S_ISDIR(info->st_mode))
        return ffd_fail_file(error, FFD_E_IO, path, "is a folder");
    if (S_ISREG(info->st_mode) || S_ISCHR(info->st_mode))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_IO, path, "is a %s, not a file (- writes to standard output)",
                         S_ISFIFO(info->st_mode)   ? "pipe"
                         : S_ISSOCK(info->st_mode) ? "socket"
                                                   : "device");
}

/* Returns whether a file is a mount point or immutable. */
static bool is_fixed(const char *path)
{
#ifdef STATX_ATTR_MOUNT_ROOT
    struct statx info;
    return statx(AT_FDCWD, path, 0, 0, &info) == 0 &&
           info.stx_attributes & (STATX_ATTR_MOUNT_ROOT | STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND);
#elif defined(UF_IMMUTABLE)
    struct stat info;
    return stat(path, &info) == 0 && info.st_flags & (UF_IMMUTABLE | UF_APPEND | SF_IMMUTABLE | SF_APPEND);
#else
    (void)path;
    return false;
#endif
}

/* Returns whether the folder has the sticky bit, so that this user may not rename a file of another owner in
   it. */
static bool is_held_by_folder(const char *path, const struct stat *info)
{
    struct stat folder = {0};
    if (geteuid() == 0 || geteuid() == info->st_uid)
        return false;
    char *const target = realpath(path, NULL), *const name = target ? ffd_path_folder(target) : NULL;
    const bool found = name && stat(name, &folder) == 0;
    free(target);
    ffd_free(name);
    return found && folder.st_mode & S_ISVTX && geteuid() != folder.st_uid;
}

/* Detects early what would otherwise fail only at the rename, when other files may have been replaced
   already. */
static ffd_status check_replaceable(const char *path, const struct stat *info, ffd_error *error)
{
    if (is_fixed(path))
        return ffd_fail_file(error, FFD_E_IO, path, "cannot be replaced: it is mounted here, or immutable");
    if (is_held_by_folder(path, info))
        return ffd_fail_file(
            error, FFD_E_IO, path,
            "cannot be replaced: it belongs to another user, in a folder with the sticky bit");
    return FFD_OK;
}

static ffd_status fail_exists(const char *path, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_EXISTS, path, "exists already ({force} overwrites it)");
}

static ffd_status check_target(const char *path, bool force, struct stat *info, bool *exists,
                               ffd_error *error)
{
    const char *const flaw = ffd_path_flaw(path);
    *exists = false;
    if (flaw)
        return ffd_fail_file(error, FFD_E_IO, path, "cannot be written: \"%s\" %s", path, flaw);
    *exists = lstat(path, info) == 0;
    if (!*exists)
        return errno == ENOENT ? FFD_OK : ffd_fail_errno(error, path, "cannot be written");
    if (S_ISLNK(info->st_mode) && stat(path, info) != 0) {
        *exists = false;
        return errno == ENOENT ? ffd_fail_file(error, FFD_E_IO, path, "is a link that leads to no file")
                               : ffd_fail_errno(error, path, "cannot be written");
    }
    TRY(refuse_special(info, path, error));
    if (!S_ISREG(info->st_mode))
        return FFD_OK;
    return force ? check_replaceable(path, info, error) : fail_exists(path, error);
}

/* Refuses a missing folder, or with `makes` one that cannot be made. */
static ffd_status check_folder(const char *path, bool makes, ffd_error *error)
{
    char *const folder = ffd_path_folder(path);
    TRY(folder ? FFD_OK : ffd_fail_memory(error));
    const ffd_status status =
        makes ? ffd_folder_check(folder, error)
        : ffd_folder_is_there(folder)
            ? FFD_OK
            : ffd_fail_file(error, FFD_E_IO, path, "cannot be written: there is no folder \"%s\"", folder);
    ffd_free(folder);
    return status;
}

static ffd_status check_output(const char *path, bool force, bool makes_folder, ffd_error *error)
{
    struct stat info;
    bool exists;
    if (ffd_output_is_stream(path))
        return FFD_OK;
    TRY(check_target(path, force, &info, &exists, error));
    return exists ? FFD_OK : check_folder(path, makes_folder, error);
}

ffd_status ffd_output_check(const char *path, bool force, ffd_error *error)
{
    return check_output(path, force, false, error);
}

ffd_status ffd_output_check_with_folder(const char *path, bool force, ffd_error *error)
{
    return check_output(path, force, true, error);
}

/* Opens a character device without blocking. */
static ffd_status open_device(output_file *file, const char *path, ffd_error *error)
{
    struct stat info;
    file->fd = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file->fd < 0 || fstat(file->fd, &info) != 0 ||
        fcntl(file->fd, F_SETFL, fcntl(file->fd, F_GETFL) & ~O_NONBLOCK) != 0)
        return ffd_fail_errno(error, path, "cannot be written");
    return S_ISCHR(info.st_mode) ? FFD_OK : ffd_fail_file(error, FFD_E_IO, path, "is not a device any more");
}

/* Makes the folders of the set again: another run has removed what it had made, because it was empty. */
static ffd_status remake_folders(file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->folder_count; i++) {
        output_folder *const folder = &output->folders[i];
        size_t made;
        TRY(ffd_folder_make(folder->path, &made, error));
        if (!made || (folder->made && folder->made <= made))
            continue;
        folder->made = made;
        ffd_cleanup_strike(&folder->noted);
        folder->noted = ffd_cleanup_note_folder(folder->path, made);
    }
    return FFD_OK;
}

/* Opens the temporary file. output->was_busy: another run is writing the target. */
static ffd_status open_temporary(file_output *output, output_file *file, const char *path,
                                 const struct stat *old, ffd_error *error)
{
    file->temporary = ffd_temporary_name(file->target);
    if (!file->temporary)
        return ffd_fail_memory(error);
    ffd_cleanup_hold();
    file->fd = ffd_temporary_open(file->temporary);
    for (int again = 0; file->fd < 0 && errno == ENOENT && output->folder_count && again < FOLDER_TRIES;
         again++)
        file->fd = remake_folders(output, NULL) ? -1 : ffd_temporary_open(file->temporary);
    const int reason = errno;
    file->noted = file->fd < 0 ? NULL : ffd_cleanup_note(file->temporary);
    ffd_cleanup_release();
    if (file->fd >= 0 && !file->noted)
        return ffd_fail_memory(error);
    if (file->fd < 0) {
        const ffd_status status = ffd_temporary_fail(reason, file->temporary, path, error);
        ffd_free(file->temporary); /* it belongs to another run */
        file->temporary = NULL;
        output->was_busy = reason == EBUSY;
        return status;
    }
    /* Only root can change the owner of a file. */
    if (old && (old->st_uid != geteuid() || old->st_gid != getegid())) {
        const int given = fchown(file->fd, old->st_uid, old->st_gid);
        (void)given;
    }
    if (old && fchmod(file->fd, old->st_mode & 0777) != 0)
        return ffd_fail_errno(error, path, "its permissions cannot be kept");
    return FFD_OK;
}

/* Removes the temporary file, unless it belongs to another run by now: where there are no locks, that run has
   taken it for a leftover. */
static void remove_temporary(const output_file *file)
{
    if (!ffd_names_other(file->fd, file->temporary))
        unlink(file->temporary);
}

/* Removes the temporary file and releases its lock. */
static void drop_temporary(output_file *file)
{
    ffd_cleanup_hold();
    remove_temporary(file);
    ffd_cleanup_strike(&file->noted);
    ffd_cleanup_release();
    close(file->fd);
    file->fd = -1;
    ffd_free(file->temporary);
    file->temporary = NULL;
}

/* Writes to the file begun last. */
static ffd_status write_all(file_output *output, const unsigned char *bytes, size_t size, ffd_error *error)
{
    output_file *const file = &output->files[output->count - 1];
    size_t done = 0;
    if (output->sink) {
        ffd_buffer_append(&file->bytes, bytes, size);
        return file->bytes.failed ? ffd_fail_memory(error) : FFD_OK;
    }
    while (done < size) {
        const ssize_t written = write(file->fd, bytes + done, size - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return ffd_fail_errno(error, shown(file->target), "cannot be written");
        done += (size_t)written;
    }
    return FFD_OK;
}

static ffd_status flush(file_output *output, ffd_error *error)
{
    if (output->count == 0)
        return FFD_OK;
    TRY(write_all(output, output->block, output->filled, error));
    output->filled = 0;
    return FFD_OK;
}

ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error)
{
    output->was_busy = false;
    TRY(flush(output, error));
    if (!ffd_grow((void **)&output->files, &output->capacity, output->count + 1, sizeof *output->files))
        return ffd_fail_memory(error);
    output_file *file = &output->files[output->count];
    *file = (output_file){.fd = -1, .force = force};

    struct stat info;
    bool exists = false;
    if (!ffd_output_is_stream(path) && !output->sink)
        TRY(check_target(path, force, &info, &exists, error));
    char *resolved = exists && S_ISREG(info.st_mode) ? realpath(path, NULL) : NULL;
    file->target = ffd_text_copy(resolved ? resolved : path);
    free(resolved);
    if (!file->target)
        return ffd_fail_memory(error);
    output->count++;

    if (output->sink)
        return FFD_OK;
    if (ffd_output_is_stream(path)) {
        file->fd = dup(stream_of(path));
        return file->fd < 0 ? ffd_fail_errno(error, shown(path), "cannot be written") : FFD_OK;
    }
    TRY(exists ? refuse_written(output, path, error) : FFD_OK);
    if (exists && !S_ISREG(info.st_mode))
        return open_device(file, path, error);
    ffd_status status;
    TRY_END(open_temporary(output, file, path, exists ? &info : NULL, error));
    /* Another run may have created the target before this one got the lock. */
    if (!force && lstat(file->target, &info) == 0) {
        drop_temporary(file);
        TRY_END(fail_exists(path, error));
    }
end:
    if (status && file->fd < 0) { /* the set is as before the call */
        ffd_free(file->target);
        output->count--;
    }
    return status;
}

ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error)
{
    if (output->sink)
        return FFD_OK;
    if (!ffd_grow((void **)&output->folders, &output->folder_capacity, output->folder_count + 1,
                  sizeof *output->folders))
        return ffd_fail_memory(error);
    output_folder *folder = &output->folders[output->folder_count];
    *folder = (output_folder){.path = ffd_text_copy(path)};
    if (!folder->path)
        return ffd_fail_memory(error);
    output->folder_count++;
    if (ffd_folder_is_there(path))
        return FFD_OK;
    ffd_cleanup_hold();
    const ffd_status status = ffd_folder_make(path, &folder->made, error);
    folder->noted = folder->made ? ffd_cleanup_note_folder(path, folder->made) : NULL;
    ffd_cleanup_release();
    TRY(status);
    return folder->made && !folder->noted ? ffd_fail_memory(error) : FFD_OK;
}

/* Empties the block, in time: a file that is complete or absent is not written on after the deadline. */
static ffd_status make_room(file_output *output, ffd_error *error)
{
    const output_file *const file = &output->files[output->count - 1];
    TRY(file->temporary || output->sink ? ffd_deadline_check(error) : FFD_OK);
    return flush(output, error);
}

ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error)
{
    TRY(size > BLOCK - output->filled ? make_room(output, error) : FFD_OK);
    if (output->hash && output->count == 1)
        ffd_hash_stream_add(output->hash, bytes, size);
    if (size >= BLOCK)
        return write_all(output, bytes, size, error);
    if (size > 0)
        memcpy(output->block + output->filled, bytes, size);
    output->filled += size;
    return FFD_OK;
}

int ffd_output_keep_open(file_output *output)
{
    output->files[output->count - 1].stays_open = true;
    return output->files[output->count - 1].fd;
}

/* Some file systems report a full disk only when a file is closed. Closing a duplicate descriptor triggers
   the report while the old target still exists, and keeps the lock. */
static ffd_status check_written(const file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->count; i++) {
        const output_file *file = &output->files[i];
        const int twin = file->temporary ? dup(file->fd) : -1;
        if (file->temporary && (twin < 0 || close(twin) != 0))
            return ffd_fail_errno(error, file->target, "cannot be written");
        if (file->temporary && ffd_names_other(file->fd, file->temporary))
            return ffd_fail_file(error, FFD_E_IO, file->target, "is being written by another run");
    }
    return FFD_OK;
}

ffd_status ffd_output_flush(file_output *output, ffd_error *error)
{
    TRY(flush(output, error));
    return check_written(output, error);
}

void ffd_output_keep_equal(file_output *output)
{
    output->keeps_equal = true;
}

/* Returns whether a target already has the bytes written for it; false if it cannot be read. */
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

/* Releases a file that is renamed, or whose target stays. */
static ffd_status settle_file(output_file *file, ffd_error *error)
{
    file->committed = true;
    ffd_cleanup_strike(&file->noted);
    if (file->stays_open || file->fd < 0)
        return FFD_OK;
    /* Closing releases the lock: only now may another run use the temporary name. */
    const int fd = file->fd;
    file->fd = -1;
    return close(fd) == 0 ? FFD_OK : ffd_fail_errno(error, file->target, "cannot be written");
}

/* Removes the temporary files and keeps the targets. */
static ffd_status drop_all(const file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->count; i++) {
        const output_file *const file = &output->files[i];
        if (file->temporary && unlink(file->temporary) != 0)
            return ffd_fail_errno(error, file->target, "cannot be written");
    }
    return FFD_OK;
}

/* Renames the temporary files to the targets. */
static ffd_status place_all(file_output *output, ffd_error *error)
{
    size_t count = 0;
    set_file *const files = ffd_alloc(output->count, sizeof *files);
    if (!files)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < output->count; i++) {
        const output_file *const file = &output->files[i];
        if (file->temporary)
            files[count++] =
                (set_file){.target = file->target, .temporary = file->temporary, .replace = file->force};
    }
    const ffd_status status = ffd_set_place(files, count, error);
    for (size_t i = 0, k = 0; i < output->count; i++)
        if (output->files[i].temporary)
            output->files[i].committed = files[k++].is_gone;
    ffd_free(files);
    return status;
}

/* Passes the files to the sink in the order in which they were begun, so the head of the set comes last. Does
   not allocate. */
static ffd_status give_all(const file_output *output, ffd_error *error)
{
    for (size_t i = 0; i < output->count && output->sink; i++) {
        const output_file *const file = &output->files[i];
        const ffd_status status = ffd_status_known(output->sink(
            output->sink_user, file->target, file->bytes.size > 0 ? file->bytes.data : "", file->bytes.size));
        if (status)
            return ffd_fail_file(error, status, file->target, "was not taken by the caller");
    }
    return FFD_OK;
}

static ffd_status settle_all(file_output *output, bool stays, ffd_error *error)
{
    TRY(stays ? drop_all(output, error) : place_all(output, error));
    for (size_t i = 0; i < output->count; i++)
        TRY(settle_file(&output->files[i], error));
    for (size_t i = 0; i < output->folder_count; i++)
        ffd_cleanup_strike(&output->folders[i].noted);
    output->committed = true;
    return FFD_OK;
}

ffd_status ffd_output_commit(file_output *output, ffd_error *error)
{
    TRY(flush(output, error));
    TRY(refuse_recorded(output, error));
    TRY(check_written(output, error));
    const bool stays = output->keeps_equal && is_to_stay(output);
    TRY(record_files(output, stays, error));
    /* Signals are blocked during the renames, so that they cannot interrupt a set. */
    ffd_cleanup_hold();
    const ffd_status status = settle_all(output, stays, error);
    ffd_cleanup_release();
    /* Without the lock, because the callback may do anything. */
    return status ? status : give_all(output, error);
}

bool ffd_output_was_busy(const file_output *output)
{
    return output->was_busy;
}

void ffd_output_destroy(file_output **output)
{
    if (!output || !*output)
        return;
    const bool is_noted = !(*output)->committed; /* a commit strikes everything from the list of leftovers */
    if (is_noted)
        ffd_cleanup_hold();
    for (size_t i = 0; i < (*output)->count; i++) {
        output_file *file = &(*output)->files[i];
        if (file->temporary && !file->committed)
            remove_temporary(file);
        ffd_cleanup_strike(&file->noted);
        if (file->fd >= 0)
            close(file->fd);
        ffd_free(file->temporary);
        ffd_free(file->target);
        ffd_buffer_free(&file->bytes);
    }
    for (size_t i = (*output)->folder_count; i-- > 0;) {
        if (!(*output)->committed)
            ffd_folder_unmake((*output)->folders[i].path, (*output)->folders[i].made);
        ffd_cleanup_strike(&(*output)->folders[i].noted);
        ffd_free((*output)->folders[i].path);
    }
    if (is_noted)
        ffd_cleanup_release();
    ffd_free((*output)->folders);
    ffd_free((*output)->files);
    ffd_free((*output)->block);
    ffd_free((*output)->hash);
    ffd_free(*output);
    *output = NULL;
}
