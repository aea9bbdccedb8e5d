#include "io/obj/obj_split.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include <string.h>

static bool same_vector(const double *a, const double *b)
{
    return memcmp(a, b, 3 * sizeof *a) == 0;
}

static const double *value_of(const obj_document *d, uint32_t pair)
{
    return d->file.new_directions + 3 * (size_t)pair;
}

static bool is_unchanged(const obj_document *d, uint32_t pair)
{
    return !d->direction_changes[pair];
}

static void choose_keepers(const obj_document *d, uint32_t *keeper)
{
    for (size_t n = 0; n < d->normals; n++)
        keeper[n] = OBJ_NONE;
    for (uint32_t pair = 0; pair < d->file.part.normal_count; pair++) {
        if (d->held_normals && d->held_normals[d->pair_normal[pair]])
            continue;
        uint32_t *kept = &keeper[d->pair_normal[pair]];
        if (*kept == OBJ_NONE || (is_unchanged(d, pair) && !is_unchanged(d, *kept)))
            *kept = pair;
    }
}

static bool needs_own(const obj_document *d, const uint32_t *keeper, uint32_t pair)
{
    const uint32_t kept = keeper[d->pair_normal[pair]];
    if (kept == OBJ_NONE)
        return !is_unchanged(d, pair);
    return kept != pair && !same_vector(value_of(d, pair), value_of(d, kept));
}

/* The finalizer of MurmurHash3 over the words of a value and its `vn`. */
static uint64_t hash_of(const obj_document *d, uint32_t pair)
{
    uint64_t words[3], hash = d->pair_normal[pair];
    memcpy(words, value_of(d, pair), sizeof words);
    for (int i = 0; i < 3; i++) {
        hash = (hash ^ words[i]) * UINT64_C(0xff51afd7ed558ccd);
        hash = (hash ^ (hash >> 33)) * UINT64_C(0xc4ceb9fe1a85ec53);
        hash ^= hash >> 33;
    }
    return hash;
}

/* The added `vn` of each distinct value. */
typedef struct value_table {
    uint32_t *slots; /* OBJ_NONE: free */
    size_t mask;
} value_table;

/* The added `vn` for the pair's value, made where there is none yet. */
static uint32_t find_or_add(const obj_document *d, const value_table *table, obj_split *split, uint32_t pair)
{
    size_t at = (size_t)hash_of(d, pair) & table->mask;
    for (; table->slots[at] != OBJ_NONE; at = (at + 1) & table->mask) {
        const uint32_t other = split->added[table->slots[at]];
        if (d->pair_normal[other] == d->pair_normal[pair] &&
            same_vector(value_of(d, other), value_of(d, pair)))
            return table->slots[at];
    }
    table->slots[at] = (uint32_t)split->added_count;
    split->added[split->added_count++] = pair;
    return table->slots[at];
}

static ffd_status add_normals(const obj_document *d, size_t own_count, obj_split *split, ffd_error *error)
{
    value_table table;
    table.slots = ffd_slots_make(own_count, sizeof *table.slots, &table.mask);
    split->added = ffd_alloc(own_count, sizeof *split->added);
    split->target = ffd_alloc(d->file.part.normal_count, sizeof *split->target);
    if (!table.slots || !split->added || !split->target) {
        ffd_free(table.slots);
        return ffd_fail_memory(error);
    }
    for (uint32_t pair = 0; pair < d->file.part.normal_count; pair++)
        split->target[pair] =
            needs_own(d, split->keeper, pair) ? find_or_add(d, &table, split, pair) : OBJ_NONE;
    ffd_free(table.slots);
    return FFD_OK;
}

ffd_status ffd_obj_split_normals(const obj_document *d, obj_split *split, ffd_error *error)
{
    *split = (obj_split){.keeper = ffd_alloc(d->normals, sizeof *split->keeper)};
    if (!split->keeper)
        return ffd_fail_memory(error);
    choose_keepers(d, split->keeper);
    size_t own_count = 0;
    for (uint32_t pair = 0; pair < d->file.part.normal_count; pair++)
        own_count += needs_own(d, split->keeper, pair);
    const ffd_status status = own_count ? add_normals(d, own_count, split, error) : FFD_OK;
    if (status)
        ffd_obj_split_free(split);
    return status;
}

void ffd_obj_split_free(obj_split *split)
{
    ffd_free(split->keeper);
    ffd_free(split->added);
    ffd_free(split->target);
    memset(split, 0, sizeof *split);
}
