#include "batch/journal.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The file: a head, then slots. A record is in the slot that the hash of its output's path says, or in
   the next one that is free. */
typedef struct journal_slot {
    hash128 target;
    job_record record;
    hash128 check; /* of the members before; zeros where the slot is free */
} journal_slot;

_Static_assert(sizeof(journal_slot) == 64, "the file's slots have 64 bytes");

static const char magic[16] = "ffd-journal 1\n";
enum { HEAD = 64, FIRST_SLOTS = 1024 };

struct job_journal {
    FILE *file;
    char *path;
    uint64_t slots, used;
};

static hash128 check_of(const journal_slot *slot)
{
    return ffd_hash(slot, offsetof(journal_slot, check));
}

static bool is_free(const journal_slot *slot)
{
    static const journal_slot none = {0};
    return memcmp(slot, &none, sizeof none) == 0;
}

static bool is_whole(const journal_slot *slot)
{
    const hash128 check = check_of(slot);
    return ffd_hash_equal(&check, &slot->check);
}

static bool seek(FILE *file, uint64_t slot)
{
    return slot <= LONG_MAX / sizeof(journal_slot) - 1 &&
           fseek(file, (long)(HEAD + slot * sizeof(journal_slot)), SEEK_SET) == 0;
}

static bool read_slot(FILE *file, uint64_t number, journal_slot *slot)
{
    return seek(file, number) && fread(slot, sizeof *slot, 1, file) == 1;
}

/* Where the slots of a target begin. */
static uint64_t first_slot(const hash128 *target, uint64_t slots)
{
    return load_u64(target->bytes) % slots;
}

/* The target's slot, or the one where it can be put; false where there is none. */
static bool look_up(FILE *file, uint64_t slots, const hash128 *target, uint64_t *number, journal_slot *slot)
{
    *number = first_slot(target, slots);
    for (uint64_t i = 0; i < slots; i++, *number = (*number + 1) % slots) {
        if (!read_slot(file, *number, slot))
            return false;
        if (is_free(slot) || (is_whole(slot) && ffd_hash_equal(&slot->target, target)))
            return true;
    }
    return false;
}

static bool write_slot(FILE *file, uint64_t number, const journal_slot *slot)
{
    return seek(file, number) && fwrite(slot, sizeof *slot, 1, file) == 1;
}

/* A new table without records. */
static bool write_empty(FILE *file, uint64_t slots)
{
    unsigned char head[HEAD] = {0};
    const journal_slot none = {0};
    memcpy(head, magic, sizeof magic);
    store_u64(head + sizeof magic, slots);
    bool written = fseek(file, 0, SEEK_SET) == 0 && fwrite(head, sizeof head, 1, file) == 1;
    for (uint64_t i = 0; i < slots && written; i++)
        written = fwrite(&none, sizeof none, 1, file) == 1;
    return written && fflush(file) == 0;
}

/* Reads the head; counts the records. */
static bool read_table(job_journal *journal)
{
    unsigned char head[HEAD];
    journal_slot slot;
    if (fseek(journal->file, 0, SEEK_SET) != 0 || fread(head, sizeof head, 1, journal->file) != 1 ||
        memcmp(head, magic, sizeof magic) != 0)
        return false;
    journal->slots = load_u64(head + sizeof magic);
    journal->used = 0;
    for (uint64_t i = 0; i < journal->slots; i++) {
        if (fread(&slot, sizeof slot, 1, journal->file) != 1)
            return false;
        journal->used += !is_free(&slot);
    }
    return journal->slots > 0;
}

/* Whether the file that is there is a journal, even one that was cut off early. */
static bool is_journal(FILE *file)
{
    char start[sizeof magic];
    rewind(file);
    const size_t size = fread(start, 1, sizeof start, file);
    return memcmp(start, magic, size) == 0;
}

static ffd_status open_table(job_journal *journal, ffd_error *error)
{
    journal->file = fopen(journal->path, "r+b");
    if (journal->file) {
        if (read_table(journal))
            return FFD_OK;
        if (!is_journal(journal->file))
            return ffd_fail_file(error, FFD_E_INVALID, journal->path, "is not a journal; it is not replaced");
        fclose(journal->file);
    }
    errno = 0;
    journal->file = fopen(journal->path, "w+b");
    journal->slots = FIRST_SLOTS;
    if (!journal->file || !write_empty(journal->file, journal->slots))
        return ffd_fail_file(error, FFD_E_IO, journal->path, "cannot be written: %s",
                             errno ? strerror(errno) : "unknown reason");
    return FFD_OK;
}

ffd_status ffd_journal_open(const char *path, job_journal **journal, ffd_error *error)
{
    size_t made;
    char *const folder = ffd_path_folder(path);
    *journal = ffd_alloc_zero(1, sizeof **journal);
    if (*journal)
        (*journal)->path = ffd_text_copy(path);
    ffd_status status = folder && *journal && (*journal)->path ? FFD_OK : ffd_fail_memory(error);
    if (!status)
        status = ffd_folder_make(folder, &made, error);
    if (!status)
        status = open_table(*journal, error);
    ffd_free(folder);
    if (status)
        ffd_journal_close(journal);
    return status;
}

/* Targets are distinguished by their full paths. */
static hash128 hash_target(const char *target)
{
    char *const folder = ffd_path_folder(target);
    char *const resolved = folder ? ffd_path_resolve(folder) : NULL;
    const char *const start = resolved ? resolved : target, *const name = ffd_path_name(target);
    const hash_block blocks[] = {{start, strlen(start) + 1}, {name, strlen(name)}};
    const hash128 hash = ffd_hash_blocks(blocks, 2);
    ffd_free(folder);
    ffd_free(resolved);
    return hash;
}

bool ffd_journal_find(job_journal *journal, const char *target, job_record *record)
{
    const hash128 hash = hash_target(target);
    journal_slot slot;
    uint64_t number;
    if (!look_up(journal->file, journal->slots, &hash, &number, &slot) || is_free(&slot))
        return false;
    *record = slot.record;
    return true;
}

/* Copies the whole records into a table of twice the size, which replaces the old one. */
static bool grow(job_journal *journal)
{
    const uint64_t slots = 2 * journal->slots;
    const size_t capacity = strlen(journal->path) + sizeof ".new";
    char *const name = ffd_alloc(capacity, 1);
    journal_slot slot, other;
    uint64_t number;
    if (!name)
        return false;
    snprintf(name, capacity, "%s.new", journal->path);
    FILE *file = fopen(name, "w+b");
    bool grown = file && write_empty(file, slots);
    uint64_t used = 0;
    for (uint64_t i = 0; i < journal->slots && grown; i++) {
        grown = read_slot(journal->file, i, &slot);
        if (!grown || is_free(&slot) || !is_whole(&slot))
            continue;
        grown = look_up(file, slots, &slot.target, &number, &other) && write_slot(file, number, &slot);
        used++;
    }
    grown = grown && fflush(file) == 0 && rename(name, journal->path) == 0;
    if (grown) {
        fclose(journal->file);
        journal->file = file;
        journal->slots = slots;
        journal->used = used;
    } else if (file) {
        fclose(file);
        remove(name);
    }
    ffd_free(name);
    return grown;
}

bool ffd_journal_put(job_journal *journal, const char *target, const job_record *record)
{
    journal_slot slot = {.target = hash_target(target), .record = *record}, there;
    uint64_t number;
    slot.check = check_of(&slot);
    if (journal->used > journal->slots / 2 && !grow(journal) && journal->used + 1 >= journal->slots)
        return false;
    if (!look_up(journal->file, journal->slots, &slot.target, &number, &there))
        return false;
    journal->used += is_free(&there);
    return write_slot(journal->file, number, &slot) && fflush(journal->file) == 0;
}

void ffd_journal_close(job_journal **journal)
{
    if (!*journal)
        return;
    if ((*journal)->file)
        fclose((*journal)->file);
    ffd_free((*journal)->path);
    ffd_free(*journal);
    *journal = NULL;
}

/* The folder of the user's caches, and below it: free with ffd_free. */
static char *cache_folder(void)
{
    const char *const caches = getenv("XDG_CACHE_HOME"), *const home = getenv("HOME"),
                      *const local = getenv("LOCALAPPDATA");
    if (caches && ffd_path_is_absolute(caches))
        return ffd_path_join(caches, "ffd");
    if (home && *home)
        return ffd_path_join(home, ".cache/ffd");
    return local && *local ? ffd_path_join(local, "ffd") : NULL;
}

char *ffd_journal_default_path(const char *jobs, uint64_t shard, uint64_t shards)
{
    const hash128 hash = hash_target(jobs);
    char name[80];
    snprintf(name, sizeof name, "batch-%016" PRIx64 "%016" PRIx64 "-%" PRIu64 "-of-%" PRIu64,
             load_u64(hash.bytes), load_u64(hash.bytes + 8), shard, shards);
    char *const folder = cache_folder();
    char *const path = folder ? ffd_path_join(folder, name) : NULL;
    ffd_free(folder);
    return path;
}
