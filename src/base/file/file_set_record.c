#define _DEFAULT_SOURCE /* flock */
#include "base/file/file_set_record.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/clock.h"
#include "base/text/buffer.h"
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The content of the file: first_line, then for each file "old" or "new" (whether there was an old one), size
   and time of the new file, and its path (only a name if it is in the folder of the head); then last_line.
   Each is terminated by 0, because names may contain line breaks. */
static const char first_line[] = "ffd-set 1\n", last_line[] = "end\n";

/* The largest record in bytes: a set has at most one file for each image of a model. */
#define LARGEST ((size_t)1 << 26)
/* How often a lock is tried, at intervals of a millisecond. */
#define MOST_ATTEMPTS 1000

static const char strange[] = "is not the record of a run, though it has the name of one: remove it";
static const char busy[] = "the files beside this are being written by another run";

static char *path_for(const char *head)
{
    return ffd_hidden_name(head, ".ffd-set");
}

ffd_status ffd_record_begin(set_record *record, const char *head, ffd_error *error)
{
    *record = (set_record){.path = path_for(head), .fd = -1};
    return record->path ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_record_add(set_record *record, const char *target, bool was_there, uint64_t size,
                          const int64_t time[2], ffd_error *error)
{
    if (!ffd_grow((void **)&record->entries, &record->capacity, record->count + 1, sizeof *record->entries))
        return ffd_fail_memory(error);
    set_entry *const entry = &record->entries[record->count++];
    *entry = (set_entry){.target = ffd_text_copy(target),
                         .aside = ffd_hidden_name(target, ".ffd-old"),
                         .was_there = was_there,
                         .size = size,
                         .time = {time[0], time[1]}};
    return entry->target && entry->aside ? FFD_OK : ffd_fail_memory(error);
}

/* Returns the path as the record stores it: relative, because the folder of a model may be moved, or mounted
   elsewhere, before a later run reads the record. Free with ffd_free. Returns NULL if memory runs out. */
static char *written_path(const set_record *record, const char *target)
{
    char *const here = ffd_path_folder(record->path), *const there = ffd_path_folder(target);
    char *path = NULL;
    if (here && there && (strcmp(here, there) == 0 || ffd_file_same(here, there))) {
        path = ffd_text_copy(ffd_path_name(target));
    } else if (here && there) {
        char *const folder = ffd_path_resolve(there);
        path = folder ? ffd_path_join(folder, ffd_path_name(target)) : NULL;
        ffd_free(folder);
    }
    ffd_free(here);
    ffd_free(there);
    return path;
}

static ffd_status put_entry(const set_record *record, const set_entry *entry, byte_buffer *text,
                            ffd_error *error)
{
    char *const path = written_path(record, entry->target);
    if (!path)
        return ffd_fail_memory(error);
    ffd_buffer_format(text, "%s %" PRIu64 " %" PRId64 " %" PRId64 " ", entry->was_there ? "old" : "new",
                      entry->size, entry->time[0], entry->time[1]);
    ffd_buffer_append(text, path, strlen(path) + 1);
    ffd_free(path);
    return FFD_OK;
}

static ffd_status make_text(const set_record *record, byte_buffer *text, ffd_error *error)
{
    ffd_buffer_append(text, first_line, sizeof first_line);
    for (size_t i = 0; i < record->count; i++)
        TRY(put_entry(record, &record->entries[i], text, error));
    ffd_buffer_append(text, last_line, sizeof last_line);
    return !text->failed ? FFD_OK : ffd_fail_memory(error);
}

static ffd_status write_text(const set_record *record, const byte_buffer *text, ffd_error *error)
{
    for (size_t done = 0; done < text->size;) {
        const ssize_t written = write(record->fd, text->data + done, text->size - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return ffd_fail_errno(error, record->path, "cannot be written");
        done += (size_t)written;
    }
    return FFD_OK;
}

static ffd_status refuse(const set_record *record, const char *why, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_IO, record->path, "%s", why);
}

/* Creates the file and locks it. Between the two another run may lock it, and remove it as a record without
   entries. The file is then created again. */
static ffd_status make_file(set_record *record, ffd_error *error)
{
    for (int attempt = 0;; attempt++) {
        record->fd = open(record->path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        const bool is_there = record->fd < 0 && errno == EEXIST && attempt > 0;
        if (record->fd < 0 && !is_there)
            return ffd_fail_errno(error, record->path, "cannot be written");
        const int locked = is_there ? 0 : ffd_lock_named(record->fd, record->path);
        if (locked > 0)
            return FFD_OK;
        if (locked < 0 && errno != EBUSY) {
            const ffd_status status = ffd_fail_errno(error, record->path, "cannot be locked");
            ffd_record_remove(record);
            return status;
        }
        if (record->fd >= 0)
            close(record->fd);
        record->fd = -1;
        if (attempt == MOST_ATTEMPTS)
            return refuse(record, busy, error);
        ffd_clock_sleep(0.001);
    }
}

ffd_status ffd_record_write(set_record *record, ffd_error *error)
{
    byte_buffer text = {0};
    ffd_status status;
    TRY_END(make_text(record, &text, error));
    TRY_END(make_file(record, error));
    status = write_text(record, &text, error);
    if (status)
        ffd_record_remove(record);
end:
    ffd_buffer_free(&text);
    return status;
}

/* Refuses the record of another user, which could name any file. */
static ffd_status check_owner(const set_record *record, const struct stat *info, ffd_error *error)
{
    if (info->st_uid == geteuid())
        return FFD_OK;
    return refuse(
        record,
        "belongs to another user, whose run was killed while it wrote the files next to this: only that "
        "user's next run restores them",
        error);
}

static ffd_status check_record(const set_record *record, size_t *size, ffd_error *error)
{
    struct stat info;
    if (fstat(record->fd, &info) != 0)
        return ffd_fail_errno(error, record->path, "cannot be read");
    TRY(check_owner(record, &info, error));
    if (info.st_mode & 022 || info.st_nlink != 1 || (unsigned long long)info.st_size > LARGEST)
        return refuse(record, strange, error);
    *size = (size_t)info.st_size;
    return FFD_OK;
}

/* Reads the text at *at, up to its final 0. Returns NULL at the end. */
static const char *next_text(const char *bytes, size_t size, size_t *at)
{
    const char *const text = bytes + *at, *const end = memchr(text, 0, size - *at);
    if (!end)
        return NULL;
    *at += (size_t)(end - text) + 1;
    return text;
}

/* Parses the entry of a file. Returns false if it is not valid. */
static bool parse_entry(const set_record *record, const char *text, char **target, set_entry *entry)
{
    char kind[4];
    int end = 0;
    if (sscanf(text, "%3s %" SCNu64 " %" SCNd64 " %" SCNd64 "%n", kind, &entry->size, &entry->time[0],
               &entry->time[1], &end) != 4 ||
        text[end] != ' ')
        return false;
    const char *const path = text + end + 1;
    entry->was_there = strcmp(kind, "old") == 0;
    if ((!entry->was_there && strcmp(kind, "new") != 0) || !*ffd_path_name(path))
        return false;
    if (!ffd_path_is_absolute(path) && ffd_path_name(path) != path)
        return false;
    *target = ffd_path_is_absolute(path) ? ffd_text_copy(path) : ffd_path_sibling(record->path, path);
    return true;
}

/* Adds the entries. *whole: the last line is there; it is missing if the run was killed while it wrote the
   record. */
static ffd_status parse(set_record *record, const char *bytes, size_t size, bool *whole, ffd_error *error)
{
    size_t at = 0;
    const size_t begun = size < sizeof first_line ? size : sizeof first_line;
    *whole = false;
    if (memcmp(bytes, first_line, begun) != 0)
        return refuse(record, strange, error);
    next_text(bytes, size, &at);
    for (const char *text; (text = next_text(bytes, size, &at)) != NULL;) {
        char *target = NULL;
        set_entry entry;
        *whole = strcmp(text, last_line) == 0;
        if (*whole)
            return record->count > 0 ? FFD_OK : refuse(record, strange, error);
        if (!parse_entry(record, text, &target, &entry))
            return refuse(record, strange, error);
        const ffd_status status =
            target ? ffd_record_add(record, target, entry.was_there, entry.size, entry.time, error)
                   : ffd_fail_memory(error);
        ffd_free(target);
        TRY(status);
    }
    return FFD_OK;
}

static ffd_status read_bytes(const set_record *record, char *bytes, size_t size, ffd_error *error)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = pread(record->fd, bytes + done, size - done, (off_t)done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return ffd_fail_errno(error, record->path, "cannot be read");
        done += (size_t)got;
    }
    return FFD_OK;
}

static void drop_entries(set_record *record)
{
    for (size_t i = 0; i < record->count; i++) {
        ffd_free(record->entries[i].target);
        ffd_free(record->entries[i].aside);
    }
    record->count = 0;
}

static ffd_status read_entries(set_record *record, ffd_error *error)
{
    size_t size = 0;
    bool whole = false;
    TRY(check_record(record, &size, error));
    char *const bytes = ffd_alloc(size, 1);
    ffd_status status;
    TRY_END(bytes ? read_bytes(record, bytes, size, error) : ffd_fail_memory(error));
    TRY_END(parse(record, bytes, size, &whole, error));
end:
    ffd_free(bytes);
    if (!whole)
        drop_entries(record);
    return status;
}

/* After a failure to open the record: succeeds if there is none (problems with the folder are reported
   elsewhere), otherwise says why it cannot be used. */
static ffd_status explain(const set_record *record, ffd_error *error)
{
    const int reason = errno;
    struct stat info;
    if (reason == ENOENT || lstat(record->path, &info) != 0)
        return FFD_OK;
    errno = reason;
    TRY(check_owner(record, &info, error));
    return ffd_fail_errno(error, record->path, "cannot be opened");
}

/* Opens and locks the record. Success without a descriptor: there is none. */
static ffd_status open_locked(set_record *record, ffd_error *error)
{
    for (int attempt = 0;; attempt++) {
        record->fd = open(record->path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (record->fd < 0)
            return explain(record, error);
        const int locked = ffd_lock_named(record->fd, record->path);
        if (locked > 0)
            return FFD_OK;
        const int reason = errno;
        close(record->fd);
        record->fd = -1;
        errno = reason;
        if (locked < 0 && (errno != EBUSY || attempt >= MOST_ATTEMPTS))
            return errno == EBUSY ? refuse(record, busy, error)
                                  : ffd_fail_errno(error, record->path, "cannot be locked");
        if (locked < 0)
            ffd_clock_sleep(0.001);
    }
}

ffd_status ffd_record_open(set_record *record, const char *head, ffd_error *error)
{
    TRY(ffd_record_begin(record, head, error));
    TRY(open_locked(record, error));
    if (record->fd >= 0)
        TRY(read_entries(record, error));
    return FFD_OK;
}

bool ffd_record_exists(const char *head)
{
    struct stat info;
    char *const path = path_for(head);
    const bool exists = path && lstat(path, &info) == 0;
    ffd_free(path);
    return exists;
}

int ffd_record_remove(const set_record *record)
{
    return unlink(record->path);
}

void ffd_record_free(set_record *record)
{
    drop_entries(record);
    ffd_free(record->entries);
    ffd_free(record->path);
    if (record->fd >= 0)
        close(record->fd);
    *record = (set_record){.fd = -1};
}
