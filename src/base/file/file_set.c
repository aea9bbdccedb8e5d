#define _XOPEN_SOURCE 700 /* lstat */
#include "base/file/file_set.h"
#include "base/file/file_set_record.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/temporary.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <ffd/job.h>
#include <string.h>

static bool exists(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

/* Returns whether the entry's new file has its name already. A copy with the same size and time, for instance
   in a copied folder, counts too. */
static bool is_placed(const set_entry *entry)
{
    file_stamp there;
    return ffd_file_stamp(entry->target, &there) && there.size == entry->size &&
           there.written[0] == entry->time[0] && there.written[1] == entry->time[1];
}

static ffd_status fail_place(const char *path, ffd_error *error)
{
    if (errno == EEXIST)
        return ffd_fail_file(error, FFD_E_EXISTS, path, "exists already ({force} overwrites it)");
    return ffd_fail_errno(error, path, "cannot be written");
}

/* Rolls forward: removes the old files that were set aside. */
static ffd_status finish(const set_record *record, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < record->count; i++) {
        const set_entry *const entry = &record->entries[i];
        if (entry->was_there && unlink(entry->aside) != 0 && errno != ENOENT)
            status = ffd_fail_errno(error, entry->aside, "was replaced, but cannot be removed");
    }
    return status;
}

/* Checks that nobody has put another file where an old one is to be restored. */
static ffd_status check_places(const set_record *record, ffd_error *error)
{
    for (size_t i = 0; i < record->count; i++) {
        const set_entry *const entry = &record->entries[i];
        if (entry->was_there && exists(entry->aside) && exists(entry->target) && !is_placed(entry) &&
            !ffd_file_same(entry->aside, entry->target))
            return ffd_fail_file(error, FFD_E_IO, entry->target,
                                 "stands where %s, set aside by a run that was killed, is to come back to: "
                                 "remove one of them",
                                 ffd_path_name(entry->aside));
    }
    return FFD_OK;
}

/* Restores an old file. Windows does not replace a file that is open, as the new one still is after a failure
   of this run: there it gets its temporary name again before it is removed. */
static int bring_back(const set_entry *entry)
{
    if (ffd_place(entry->aside, entry->target, true) == 0)
        return 0;
    const int reason = errno;
    char *const name = is_placed(entry) ? ffd_temporary_name(entry->target) : NULL;
    const bool is_moved = name && ffd_place(entry->target, name, false) == 0;
    const int failed = is_moved ? ffd_place(entry->aside, entry->target, false) : -1;
    if (is_moved && !failed)
        unlink(name);
    ffd_free(name);
    errno = is_moved ? errno : reason;
    return failed;
}

/* Rolls back: removes the new files and restores those that were set aside, the head last. */
static ffd_status undo(const set_record *record, ffd_error *error)
{
    TRY(check_places(record, error));
    for (size_t i = 0; i < record->count; i++) {
        const set_entry *const entry = &record->entries[i];
        int failed = 0;
        if (entry->was_there && ffd_file_same(entry->aside, entry->target)) /* two hard links to one file */
            failed = unlink(entry->aside);
        else if (entry->was_there && exists(entry->aside))
            failed = bring_back(entry);
        else if (!entry->was_there && is_placed(entry))
            failed = unlink(entry->target);
        if (failed)
            return ffd_fail_errno(error, entry->target, "what was there before cannot be brought back");
    }
    return FFD_OK;
}

/* Completes the new files or restores the old ones, then removes the record. */
static ffd_status settle(const set_record *record, bool is_done, ffd_error *error)
{
    TRY(is_done ? finish(record, error) : undo(record, error));
    if (ffd_record_remove(record) != 0 && errno != ENOENT)
        return ffd_fail_errno(error, record->path, "cannot be removed");
    return FFD_OK;
}

/* Returns whether the head is placed. It is placed last, so this tells how far a killed run came. */
static bool has_head(const set_record *record)
{
    return record->count > 0 && is_placed(&record->entries[record->count - 1]);
}

static ffd_status set_aside(const set_record *record, ffd_error *error)
{
    for (size_t i = record->count; i-- > 0;) {
        const set_entry *const entry = &record->entries[i];
        if (entry->was_there && ffd_place(entry->target, entry->aside, false) != 0)
            return errno == EEXIST ? ffd_fail_file(error, FFD_E_IO, entry->aside, "is in the way: remove it")
                                   : ffd_fail_errno(error, entry->target, "cannot be replaced");
    }
    return FFD_OK;
}

static ffd_status place_all(set_file *files, size_t count, ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (ffd_place(files[i].temporary, files[i].target, false) != 0)
            return fail_place(files[i].target, error);
        files[i].is_gone = true;
    }
    return FFD_OK;
}

/* Records the files to be placed, and which targets exist. */
static ffd_status survey(const set_file *files, size_t count, set_record *record, ffd_error *error)
{
    TRY(ffd_record_begin(record, files[count - 1].target, error));
    for (size_t i = 0; i < count; i++) {
        struct stat there;
        file_stamp made;
        const bool is_there = lstat(files[i].target, &there) == 0;
        if (is_there && !files[i].replace) {
            errno = EEXIST;
            return fail_place(files[i].target, error);
        } else if (is_there && !S_ISREG(there.st_mode)) {
            return ffd_fail_file(error, FFD_E_IO, files[i].target, "is not a file");
        } else if (!ffd_file_stamp(files[i].temporary, &made)) {
            return ffd_fail_errno(error, files[i].target, "cannot be written");
        } else {
            TRY(ffd_record_add(record, files[i].target, is_there, made.size, made.written, error));
        }
    }
    return FFD_OK;
}

/* Adds to the error that the old files could not be restored either. */
static void mention_record(const set_record *record, ffd_error *error)
{
    if (error && exists(record->entries[record->count - 1].aside))
        ffd_fail_file(error, error->status, error->file,
                      "%s; what was there before stands beside it as %s until the next run that writes it",
                      error->message, ffd_path_name(record->entries[record->count - 1].aside));
}

static ffd_status place_set(set_file *files, size_t count, const set_record *record, ffd_error *error)
{
    ffd_status status;
    TRY_END(set_aside(record, error));
    TRY_END(place_all(files, count, error));
    /* This run knows what it has placed: looking at the head could fail, or somebody could have moved it. */
    return settle(record, true, error);
end:
    if (settle(record, false, NULL))
        mention_record(record, error);
    return status;
}

ffd_status ffd_set_place(set_file *files, size_t count, ffd_error *error)
{
    set_record record = {.fd = -1};
    if (count == 1 && ffd_place(files->temporary, files->target, files->replace) != 0)
        return fail_place(files->target, error);
    if (count <= 1) {
        for (size_t i = 0; i < count; i++)
            files[i].is_gone = true;
        return FFD_OK;
    }
    ffd_status status;
    TRY_END(survey(files, count, &record, error));
    TRY_END(ffd_record_write(&record, error));
    TRY_END(place_set(files, count, &record, error));
end:
    ffd_record_free(&record);
    return status;
}

ffd_status ffd_restore_output(const char *path, ffd_error *error)
{
    set_record record = {.fd = -1};
    char *const head = ffd_path_follow(path);
    ffd_status status;
    TRY_END(head ? ffd_record_open(&record, head, error) : ffd_fail_memory(error));
    if (record.fd >= 0)
        TRY_END(settle(&record, has_head(&record), error));
    for (size_t i = 0; i < record.count; i++)
        ffd_temporary_remove(record.entries[i].target);
end:
    ffd_record_free(&record);
    ffd_free(head);
    return status;
}
