#include "base/file/cleanup.h"
#include "base/file/cleanup_list.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"

struct cleanup_entry {
    cleanup_entry *older, *newer;
    char *path;
    size_t made; /* for a folder, as ffd_folder_make sets it; 0: a file */
    pid_t owner;
};

static cleanup_entry *newest; /* protected by the lock */

cleanup_entry *ffd_cleanup_note_folder(const char *path, size_t made)
{
    cleanup_entry *entry = ffd_alloc(1, sizeof *entry);
    char *copy = entry ? ffd_text_copy(path) : NULL;
    if (!copy) {
        ffd_free(entry);
        return NULL;
    }
    *entry = (cleanup_entry){.older = newest, .path = copy, .made = made, .owner = getpid()};
    if (newest)
        newest->newer = entry;
    newest = entry;
    return entry;
}

cleanup_entry *ffd_cleanup_note(const char *path)
{
    return ffd_cleanup_note_folder(path, 0);
}

void ffd_cleanup_strike(cleanup_entry **entry)
{
    cleanup_entry *gone = *entry;
    if (!gone)
        return;
    if (gone->older)
        gone->older->newer = gone->newer;
    if (gone->newer)
        gone->newer->older = gone->older;
    else
        newest = gone->older;
    ffd_free(gone->path);
    ffd_free(gone);
    *entry = NULL;
}

/* The newest first, so that files go before their folders. */
void ffd_cleanup_remove_all(void)
{
    for (const cleanup_entry *entry = newest; entry; entry = entry->older) {
        if (entry->owner != getpid())
            continue;
        if (entry->made)
            ffd_folder_unmake(entry->path, entry->made);
        else
            unlink(entry->path);
    }
}
