/* twins.c - ffd_picture_twins: finds vertices at the same position. */
#include "base/memory/memory.h"
#include "picture/picture.h"
#include <string.h>

#define EMPTY UINT32_MAX

/* Returns the bits of a coordinate, with -0 as 0. */
static uint64_t bits_of(double coordinate)
{
    uint64_t bits;
    coordinate += 0.0;
    memcpy(&bits, &coordinate, sizeof bits);
    return bits;
}

static uint64_t key_of(const double point[3], uint64_t bits[3])
{
    uint64_t key = 0;
    for (int a = 0; a < 3; a++) {
        bits[a] = bits_of(point[a]);
        /* The finalizer of SplitMix64 (Steele, Lea, Flood 2014). */
        key = (key ^ bits[a]) * UINT64_C(0xBF58476D1CE4E5B9);
        key = (key ^ (key >> 29)) * UINT64_C(0x94D049BB133111EB);
        key ^= key >> 32;
    }
    return key;
}

static bool is_at(const double point[3], const uint64_t bits[3])
{
    return bits_of(point[0]) == bits[0] && bits_of(point[1]) == bits[1] && bits_of(point[2]) == bits[2];
}

ffd_status ffd_picture_twins(const double *positions, size_t count, uint32_t *twins, ffd_error *error)
{
    size_t capacity = 16;
    while (capacity / 2 < count)
        capacity *= 2;
    uint32_t *const slots = ffd_alloc(capacity, sizeof *slots);
    if (!slots)
        return ffd_fail_memory(error);
    memset(slots, 0xff, capacity * sizeof *slots);
    for (size_t v = 0; v < count; v++) {
        uint64_t bits[3];
        size_t slot = (size_t)key_of(positions + 3 * v, bits) & (capacity - 1);
        while (slots[slot] != EMPTY && !is_at(positions + 3 * (size_t)slots[slot], bits))
            slot = (slot + 1) & (capacity - 1);
        if (slots[slot] == EMPTY)
            slots[slot] = (uint32_t)v;
        twins[v] = slots[slot];
    }
    ffd_free(slots);
    return FFD_OK;
}
