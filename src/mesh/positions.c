#include "mesh/positions.h"
#include "base/memory/hash.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include <string.h>

ffd_status ffd_positions_begin(position_table *table, const double *positions, size_t most, ffd_error *error)
{
    *table = (position_table){.positions = positions};
    table->slots = ffd_slots_make(most, sizeof *table->slots, &table->mask);
    return table->slots ? FFD_OK : ffd_fail_memory(error);
}

/* Makes the key of a position, with -0 as 0. */
static void make_key(const double position[3], double key[3])
{
    for (size_t a = 0; a < 3; a++)
        key[a] = position[a] + 0.0;
}

static const double *position_of(const position_table *table, uint32_t vertex)
{
    return table->positions + 3 * (size_t)vertex;
}

uint32_t *ffd_positions_at(const position_table *table, const double position[3])
{
    double key[3], other[3];
    size_t at;
    make_key(position, key);
    const hash128 hash = ffd_hash(key, sizeof key);
    memcpy(&at, hash.bytes, sizeof at);
    for (at &= table->mask; table->slots[at] != UINT32_MAX; at = (at + 1) & table->mask) {
        make_key(position_of(table, table->slots[at]), other);
        if (memcmp(key, other, sizeof key) == 0)
            break;
    }
    return &table->slots[at];
}

uint32_t ffd_positions_add(position_table *table, uint32_t vertex)
{
    uint32_t *const slot = ffd_positions_at(table, position_of(table, vertex));
    if (*slot == UINT32_MAX)
        *slot = vertex;
    return *slot;
}

bool ffd_positions_find(const position_table *table, uint32_t vertex, uint32_t *found)
{
    *found = *ffd_positions_at(table, position_of(table, vertex));
    return *found != UINT32_MAX;
}

void ffd_positions_end(position_table *table)
{
    ffd_free(table->slots);
    *table = (position_table){0};
}
