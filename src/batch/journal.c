/* journal.c - a table file of our own instead of SQLite, which was tried with 10,000 records on one disk.

   Every job must be recorded when it ends, because a batch that was killed resumes from there. One
   transaction a job takes SQLite 165 to 225 us, and this table 21 to 27 us. One transaction for 100 jobs
   takes SQLite 13 to 18 us a job, but a kill then loses up to 99 records. SQLite also opens its rollback
   journal itself, without our checks: a file of that name, planted in a shared folder, is played back (in a
   trial it removed 3,000 of 3,001 records). Shards with journals on NFS would depend on NFS locks, which
   SQLite's authors advise against. Linking SQLite makes an empty program start 1.34 times as slowly (shared
   library), or 1.11 times (static). */
#include "batch/journal.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/file/update.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The file has a header, slots, then figures. It is a hash table with open addressing: a record is in the
   slot given by its output's hash, or in the next free one. Figures that no slot refers to any more are
   dropped when the table is copied. */
typedef struct journal_slot {
    hash128 target;
    job_record record;
    uint64_t begin, size; /* position of the figures in the file */
    hash128 figures;      /* hash of the figures */
    hash128 check;        /* hash of the members above; zeros in a free slot */
} journal_slot;

_Static_assert(sizeof(journal_slot) == 96, "the file's slots have 96 bytes");

/* Tables of other versions are discarded: another version of the program makes other fingerprints anyway. */
static const char magic[16] = "ffd-journal 2\n";
#define MAGIC_WORD 12 /* length of the part that all versions share */

/* Upper bound of a job's figures in bytes. */
#define FIGURES_MOST ((uint64_t)1 << 20)

/* Unreferenced bytes that make copying the table worthwhile. */
#define WASTE ((uint64_t)16 << 20)

/* Upper bound of slots: 6 GB, for 33 million jobs. A header with more is corrupt or forged. */
#define MOST_SLOTS ((uint64_t)1 << 26)

enum { HEAD = 64, FIRST_SLOTS = 1024, LEAST_SLOT = 64 /* smallest slot of any version, in bytes */ };

/* Slots per read or write of the whole table. */
#define SLOTS_AT_ONCE 256

/* Loops over slots visit at least this many slots after an interrupt, so that finished jobs are still
   recorded. */
#define FEW_SLOTS 1024

struct job_journal {
    update_file *file;
    char *path;
    uint64_t slots, used;
    uint64_t end, live; /* end of the file; bytes of referenced figures */
};

/* Whether a loop over slots must stop because the program was interrupted. */
static bool is_interrupted(uint64_t slot)
{
    return slot > FEW_SLOTS && ffd_interrupt_requested();
}

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

static uint64_t slot_begin(uint64_t index)
{
    return HEAD + index * sizeof(journal_slot);
}

static uint64_t figures_begin(uint64_t slots)
{
    return slot_begin(slots);
}

static bool read_slot(const update_file *file, uint64_t index, journal_slot *slot)
{
    return ffd_update_read(file, slot_begin(index), slot, sizeof *slot);
}

/* Returns the first slot to try for a target. */
static uint64_t first_slot(const hash128 *target, uint64_t slots)
{
    return load_u64(target->bytes) % slots;
}

/* Finds the target's slot, or the free slot where it belongs. Returns false if there is none. */
static bool find_slot(const update_file *file, uint64_t slots, const hash128 *target, uint64_t *index,
                      journal_slot *slot)
{
    *index = first_slot(target, slots);
    for (uint64_t i = 0; i < slots && !is_interrupted(i); i++, *index = (*index + 1) % slots) {
        if (!read_slot(file, *index, slot))
            return false;
        if (is_free(slot) || (is_whole(slot) && ffd_hash_equal(&slot->target, target)))
            return true;
    }
    return false;
}

static bool write_slot(update_file *file, uint64_t index, const journal_slot *slot)
{
    return ffd_update_write(file, slot_begin(index), slot, sizeof *slot);
}

/* Returns the number of slots in the next read or write, from `first` on. */
static size_t piece_of(uint64_t first, uint64_t slots)
{
    return slots - first < SLOTS_AT_ONCE ? (size_t)(slots - first) : SLOTS_AT_ONCE;
}

static bool write_head(update_file *file, uint64_t slots)
{
    unsigned char head[HEAD] = {0};
    memcpy(head, magic, sizeof magic);
    store_u64(head + sizeof magic, slots);
    return ffd_update_write(file, 0, head, sizeof head);
}

/* Writes a table without records. */
static bool write_empty(update_file *file, uint64_t slots)
{
    static const journal_slot none[SLOTS_AT_ONCE] = {0};
    bool written = write_head(file, slots);
    for (uint64_t i = 0; i < slots && written; i += SLOTS_AT_ONCE)
        written = !is_interrupted(i) &&
                  ffd_update_write(file, slot_begin(i), none, piece_of(i, slots) * sizeof *none);
    return written;
}

/* Reads the figures of a slot. */
static bool read_figures(const update_file *file, const journal_slot *slot, byte_buffer *figures)
{
    figures->size = 0;
    char *const text = slot->size <= FIGURES_MOST ? ffd_buffer_reserve(figures, slot->size + 1) : NULL;
    if (!text || !ffd_update_read(file, slot->begin, text, slot->size))
        return false;
    const hash128 hash = ffd_hash(text, slot->size);
    figures->size = slot->size;
    return ffd_hash_equal(&hash, &slot->figures);
}

/* Appends the figures of a slot to the file. Another run may have moved the end of the file. */
static bool write_figures(job_journal *journal, const char *figures, size_t size, journal_slot *slot)
{
    if (!ffd_update_size(journal->file, &slot->begin))
        return false;
    slot->size = size;
    slot->figures = ffd_hash(figures, size);
    slot->check = check_of(slot);
    journal->end = slot->begin + size;
    return ffd_update_write(journal->file, slot->begin, figures, size);
}

/* Reads the header of a journal of any version. *own: it has this version. Returns false if it is not a
   journal. */
static bool read_head(job_journal *journal, bool *own)
{
    unsigned char head[HEAD];
    if (!ffd_update_read(journal->file, 0, head, sizeof head) || memcmp(head, magic, MAGIC_WORD) != 0)
        return false;
    *own = memcmp(head, magic, sizeof magic) == 0;
    journal->slots = load_u64(head + sizeof magic);
    return ffd_update_size(journal->file, &journal->end) && journal->end >= HEAD;
}

/* Whether the file holds the slots that its header claims, of this size each. */
static bool has_slots(const job_journal *journal, size_t size)
{
    return journal->slots > 0 && journal->slots <= MOST_SLOTS &&
           journal->slots <= (journal->end - HEAD) / size;
}

/* Counts the records. Returns false if the file cannot be read. */
static bool read_slots(job_journal *journal)
{
    journal_slot slots[SLOTS_AT_ONCE];
    journal->used = journal->live = 0;
    for (uint64_t i = 0; i < journal->slots && !is_interrupted(i); i += SLOTS_AT_ONCE) {
        const size_t count = piece_of(i, journal->slots);
        if (!ffd_update_read(journal->file, slot_begin(i), slots, count * sizeof *slots))
            return false;
        for (size_t k = 0; k < count; k++) {
            journal->used += !is_free(&slots[k]);
            journal->live += is_whole(&slots[k]) ? slots[k].size : 0;
        }
    }
    return true;
}

/* Whether an existing file is a journal of any version, possibly truncated. */
static bool is_journal(const update_file *file)
{
    char start[MAGIC_WORD];
    uint64_t there;
    if (!ffd_update_size(file, &there))
        return false;
    const size_t size = there < MAGIC_WORD ? (size_t)there : MAGIC_WORD;
    return ffd_update_read(file, 0, start, size) && memcmp(start, magic, size) == 0;
}

/* Reads the table of the open file. *is_there: it has one of this version. Errors: FFD_E_INVALID (no journal,
   or a damaged one). */
static ffd_status read_table(job_journal *journal, bool *is_there, ffd_error *error)
{
    bool own = false;
    /* Only the first table is written under the journal's own name, so only it can be truncated. */
    if (read_head(journal, &own) && journal->slots != 0 && journal->slots != FIRST_SLOTS &&
        !has_slots(journal, own ? sizeof(journal_slot) : LEAST_SLOT))
        return ffd_fail_file(error, FFD_E_INVALID, journal->path,
                             "is a damaged journal: it has not the %" PRIu64
                             " records that it tells of; to begin a new one, remove it",
                             journal->slots);
    *is_there = own && has_slots(journal, sizeof(journal_slot)) && read_slots(journal);
    return *is_there || is_journal(journal->file)
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_INVALID, journal->path, "is not a journal; it is not replaced");
}

/* Writes an empty table. */
static ffd_status make_table(job_journal *journal, ffd_error *error)
{
    errno = 0;
    journal->slots = FIRST_SLOTS;
    journal->end = figures_begin(FIRST_SLOTS);
    if (!ffd_update_clear(journal->file) || !write_empty(journal->file, journal->slots))
        return errno ? ffd_fail_errno(error, journal->path, "cannot be written")
                     : ffd_fail_file(error, FFD_E_IO, journal->path, "cannot be written: unknown reason");
    return FFD_OK;
}

/* reads: as ffd_journal_read. */
static ffd_status open_journal(const char *path, bool reads, job_journal **journal, ffd_error *error)
{
    bool is_there = false;
    ffd_status status;
    *journal = ffd_alloc_zero(1, sizeof **journal);
    TRY_END(*journal ? FFD_OK : ffd_fail_memory(error));
    (*journal)->path = ffd_text_copy(path);
    TRY_END((*journal)->path ? FFD_OK : ffd_fail_memory(error));
    TRY_END(reads ? ffd_update_open_there(path, &(*journal)->file, error)
                  : ffd_update_open(path, &(*journal)->file, error));
    TRY_END(read_table(*journal, &is_there, error));
    if (!is_there && !reads)
        TRY_END(make_table(*journal, error));
    if (is_there || !reads)
        return FFD_OK;
end:
    ffd_journal_close(journal);
    return status;
}

ffd_status ffd_journal_open(const char *path, job_journal **journal, ffd_error *error)
{
    return open_journal(path, false, journal, error);
}

ffd_status ffd_journal_read(const char *path, job_journal **journal, ffd_error *error)
{
    return open_journal(path, true, journal, error);
}

bool ffd_journal_find(job_journal *journal, const hash128 *target, job_record *record, byte_buffer *figures)
{
    journal_slot slot;
    uint64_t index;
    if (!find_slot(journal->file, journal->slots, target, &index, &slot) || is_free(&slot))
        return false;
    *record = slot.record;
    return !figures || read_figures(journal->file, &slot, figures);
}

/* Copies the valid records and their figures into an empty table. */
static bool copy_table(const job_journal *journal, job_journal *copy)
{
    journal_slot slot, other;
    uint64_t index;
    byte_buffer figures = {0};
    bool copied = write_empty(copy->file, copy->slots);
    for (uint64_t i = 0; i < journal->slots && copied; i++) {
        copied = !is_interrupted(i) && read_slot(journal->file, i, &slot);
        if (!copied || is_free(&slot) || !is_whole(&slot) || !read_figures(journal->file, &slot, &figures))
            continue;
        copied = find_slot(copy->file, copy->slots, &slot.target, &index, &other) &&
                 write_figures(copy, figures.data, figures.size, &slot) &&
                 write_slot(copy->file, index, &slot);
        copy->used++;
        copy->live += slot.size;
    }
    ffd_buffer_free(&figures);
    return copied;
}

/* Replaces the table by a copy with this many slots. */
static bool rebuild(job_journal *journal, uint64_t slots)
{
    file_successor successor;
    update_file *old = journal->file;
    job_journal copy = {.path = journal->path, .slots = slots, .end = figures_begin(slots)};
    if (!ffd_successor_begin(&successor, journal->path))
        return false;
    copy.file = successor.file;
    const bool rebuilt = copy_table(journal, &copy) && ffd_successor_commit(&successor, &copy.file);
    if (rebuilt) {
        ffd_update_close(&old);
        *journal = copy;
    }
    ffd_successor_end(&successor);
    return rebuilt;
}

/* Ensures that a record can be added. Returns false if not. */
static bool reserve_slot(job_journal *journal)
{
    if (journal->used > journal->slots / 2)
        return (journal->slots <= MOST_SLOTS / 2 && rebuild(journal, 2 * journal->slots)) ||
               journal->used + 1 < journal->slots;
    if (journal->end - figures_begin(journal->slots) > 2 * journal->live + WASTE)
        rebuild(journal, journal->slots);
    return true;
}

bool ffd_journal_put(job_journal *journal, const hash128 *target, const job_record *record,
                     const char *figures, size_t size)
{
    journal_slot slot = {.target = *target, .record = *record}, there;
    uint64_t index;
    if (size > FIGURES_MOST || !reserve_slot(journal) ||
        !find_slot(journal->file, journal->slots, target, &index, &there))
        return false;
    journal->used += is_free(&there);
    journal->live += size - (is_free(&there) ? 0 : there.size);
    /* Write the figures before the slot that refers to them. */
    return write_figures(journal, figures, size, &slot) && write_slot(journal->file, index, &slot);
}

hash128 ffd_journal_copy_key(const char *base, const char *copy)
{
    static const char word[] = "copy";
    const hash128 place = ffd_place_relative(NULL, base, copy);
    const hash_block blocks[] = {{word, sizeof word}, {place.bytes, sizeof place.bytes}};
    return ffd_hash_blocks(blocks, 2);
}

void ffd_journal_close(job_journal **journal)
{
    if (!*journal)
        return;
    ffd_update_close(&(*journal)->file);
    ffd_free((*journal)->path);
    ffd_free(*journal);
    *journal = NULL;
}

void ffd_journal_mark_used(job_journal *journal)
{
    (void)write_head(journal->file, journal->slots); /* the same bytes, at a new time */
}
