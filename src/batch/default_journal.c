/* default_journal.c - the journals in the user's cache folder: their names, and how long they are kept. */
#include "base/file/cache_folder.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "batch/journal.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define NAME "batch-"

/* Every file of jobs gets a journal, also one in a folder that lasts for a minute. */
#define KEPT_SECONDS ((int64_t)180 * 24 * 60 * 60)

char *ffd_journal_default_path(const char *jobs, uint64_t shard, uint64_t shards)
{
    const hash128 hash = ffd_place_of(NULL, jobs);
    char name[80];
    snprintf(name, sizeof name, NAME "%016" PRIx64 "%016" PRIx64 "-%" PRIu64 "-of-%" PRIu64,
             load_u64(hash.bytes), load_u64(hash.bytes + 8), shard, shards);
    char *const folder = ffd_cache_folder();
    char *const path = folder ? ffd_path_join(folder, name) : NULL;
    ffd_free(folder);
    return path;
}

/* Removes the journals of a folder that were last used that long before a new one was made. */
static void remove_old(const char *folder, const char *new_journal)
{
    path_list names = {0};
    file_stamp made, used;
    const ffd_status status =
        ffd_file_stamp(new_journal, &made) ? ffd_folder_list(folder, &names, NULL) : FFD_E_IO;
    for (size_t i = 0; !status && i < names.count; i++) {
        if (strncmp(names.paths[i], NAME, sizeof NAME - 1) != 0)
            continue;
        char *const path = ffd_path_join(folder, names.paths[i]);
        if (path && ffd_file_stamp(path, &used) && made.written[0] - used.written[0] > KEPT_SECONDS)
            ffd_cache_remove(path);
        ffd_free(path);
    }
    ffd_paths_free(&names);
}

ffd_status ffd_journal_open_default(const char *path, job_journal **journal, ffd_error *error)
{
    size_t made;
    char *const folder = ffd_path_folder(path);
    const bool is_new = !ffd_file_exists(path);
    ffd_status status;
    TRY_END(folder ? ffd_folder_make(folder, &made, error) : ffd_fail_memory(error));
    TRY_END(ffd_journal_open(path, journal, error));
    if (is_new)
        remove_old(folder, path);
    else
        ffd_journal_mark_used(*journal);
end:
    ffd_free(folder);
    return status;
}
