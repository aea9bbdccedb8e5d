#include "base/memory/intern.h"
#include "base/memory/hash.h"
#include "base/memory/memory.h"
#include <string.h>

#define FREE_SLOT UINT32_MAX

static size_t key_size(const intern_table *table, uint32_t index)
{
    const size_t end = index + 1u < table->count ? table->starts[index + 1u] : table->pool_size;
    return end - table->starts[index] - 1;
}

static uint32_t *find_slot(const intern_table *table, const void *key, size_t size)
{
    const hash128 hash = ffd_hash(key, size);
    uint64_t bits;
    memcpy(&bits, hash.bytes, sizeof bits);
    size_t at = (size_t)bits & (table->slot_count - 1);
    for (; table->slots[at] != FREE_SLOT; at = (at + 1) & (table->slot_count - 1)) {
        const uint32_t index = table->slots[at];
        if (key_size(table, index) == size &&
            (size == 0 || memcmp(table->pool + table->starts[index], key, size) == 0))
            break;
    }
    return &table->slots[at];
}

/* Keeps the load factor at 1/2 or less. */
static bool make_slots(intern_table *table)
{
    if (table->slot_count / 2 > table->count)
        return true;
    size_t wanted;
    if (!ffd_multiply_size(table->slot_count ? table->slot_count : 16, 2, &wanted))
        return false;
    uint32_t *slots = ffd_alloc(wanted, sizeof *slots);
    if (!slots)
        return false;
    memset(slots, 0xff, wanted * sizeof *slots);
    ffd_free(table->slots);
    table->slots = slots;
    table->slot_count = wanted;
    for (size_t i = 0; i < table->count; i++)
        *find_slot(table, table->pool + table->starts[i], key_size(table, (uint32_t)i)) = (uint32_t)i;
    return true;
}

static bool add_key(intern_table *table, const void *key, size_t size)
{
    size_t end;
    if (table->count >= FREE_SLOT || !ffd_add_size(table->pool_size, size, &end) ||
        !ffd_add_size(end, 1, &end) ||
        !ffd_grow((void **)&table->pool, &table->pool_capacity, end, sizeof *table->pool) ||
        !ffd_grow((void **)&table->starts, &table->capacity, table->count + 1, sizeof *table->starts))
        return false;
    if (size > 0)
        memcpy(table->pool + table->pool_size, key, size);
    table->pool[end - 1] = 0;
    table->starts[table->count++] = table->pool_size;
    table->pool_size = end;
    return true;
}

bool ffd_intern(intern_table *table, const void *key, size_t size, uint32_t *index)
{
    if (!make_slots(table))
        return false;
    uint32_t *slot = find_slot(table, key, size);
    if (*slot == FREE_SLOT) {
        if (!add_key(table, key, size))
            return false;
        *slot = (uint32_t)(table->count - 1);
    }
    *index = *slot;
    return true;
}

bool ffd_intern_find(const intern_table *table, const void *key, size_t size, uint32_t *index)
{
    *index = table->count > 0 ? *find_slot(table, key, size) : FREE_SLOT;
    return *index != FREE_SLOT;
}

const char *ffd_intern_key(const intern_table *table, uint32_t index)
{
    return table->pool + table->starts[index];
}

void ffd_intern_free(intern_table *table)
{
    ffd_free(table->pool);
    ffd_free(table->starts);
    ffd_free(table->slots);
    *table = (intern_table){0};
}
