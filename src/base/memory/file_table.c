#include "base/memory/file_table.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <stdlib.h>

#define FEWEST_SLOTS ((size_t)1024)

/* Returns 0 for a free slot. */
static uint64_t index_of(const file_entry *entry)
{
    unsigned char bytes[8] = {0};
    memcpy(bytes, entry->index, sizeof entry->index);
    return load_u64(bytes);
}

static int compare(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(((file_entry *)0)->file));
}

/* Searches the sorted entries; NULL: not found. */
static file_entry *find_sorted(const file_table *table, const file_entry *entry)
{
    return table->count ? bsearch(entry, table->sorted, table->count, sizeof *entry, compare) : NULL;
}

/* Returns the slot of a recent entry, or the free slot where it belongs. */
static file_entry *find_recent(const file_table *table, const file_entry *entry)
{
    size_t i = (size_t)load_u64(entry->file) & (table->slots - 1);
    while (index_of(&table->recent[i]) && compare(&table->recent[i], entry) != 0)
        i = (i + 1) & (table->slots - 1);
    return &table->recent[i];
}

/* Merges the recent entries into the sorted ones, from the end, in place. */
static void merge(file_table *table)
{
    size_t kept = 0, to = table->count + table->used, from = table->count;
    for (size_t i = 0; i < table->slots; i++)
        if (index_of(&table->recent[i]))
            table->recent[kept++] = table->recent[i];
    if (kept > 0) /* the array may be NULL */
        qsort(table->recent, kept, sizeof *table->recent, compare);
    while (kept > 0) {
        const bool is_recent = from == 0 || compare(&table->recent[kept - 1], &table->sorted[from - 1]) > 0;
        table->sorted[--to] = is_recent ? table->recent[--kept] : table->sorted[--from];
    }
    table->count += table->used;
    table->used = 0;
}

/* Reserves a slot for a recent entry. There are slots for a sixteenth of all entries: little memory, yet
   merges are rare. */
static bool reserve_slot(file_table *table)
{
    if (table->used < table->slots / 2)
        return true;
    const size_t count = table->count + table->used;
    const size_t slots = !table->slots               ? FEWEST_SLOTS
                         : table->slots < count / 16 ? 2 * table->slots
                                                     : table->slots;
    file_entry *const recent = ffd_alloc_zero(slots, sizeof *recent);
    file_entry *const grown = recent ? ffd_realloc(table->sorted, count, sizeof *grown) : NULL;
    if (!grown) {
        ffd_free(recent);
        return false;
    }
    table->sorted = grown;
    merge(table);
    ffd_free(table->recent);
    table->recent = recent;
    table->slots = slots;
    return true;
}

ffd_status ffd_files_put(file_table *table, const hash128 *file, uint64_t index, ffd_error *error)
{
    file_entry entry;
    unsigned char bytes[8];
    store_u64(bytes, index + 1);
    memcpy(entry.file, file->bytes, sizeof entry.file);
    memcpy(entry.index, bytes, sizeof entry.index);
    file_entry *place = find_sorted(table, &entry);
    if (!place && !reserve_slot(table))
        return ffd_fail_memory(error);
    place = find_sorted(table, &entry);
    if (!place) {
        place = find_recent(table, &entry);
        table->used += index_of(place) == 0;
    }
    *place = entry;
    return FFD_OK;
}

bool ffd_files_find(const file_table *table, const hash128 *file, uint64_t *index)
{
    file_entry entry;
    memcpy(entry.file, file->bytes, sizeof entry.file);
    const file_entry *place = find_sorted(table, &entry);
    if (!place && table->slots)
        place = find_recent(table, &entry);
    const uint64_t found = place ? index_of(place) : 0;
    *index = found - 1;
    return found;
}

void ffd_files_free(file_table *table)
{
    ffd_free(table->sorted);
    ffd_free(table->recent);
    *table = (file_table){0};
}
