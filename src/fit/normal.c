#include "fit/normal.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* A place and its cell. */
typedef struct sort_entry {
    size_t cell, index;
} sort_entry;

static int compare_entries(const void *a, const void *b)
{
    const sort_entry *const x = a, *const y = b;
    return x->cell != y->cell ? (x->cell > y->cell) - (x->cell < y->cell)
                              : (x->index > y->index) - (x->index < y->index);
}

/* Lists where blocks begin. */
static void find_blocks(const sort_entry *entries, fit_places *places)
{
    for (size_t i = 0; i < places->count; i++) {
        const bool is_first = places->block_count == 0,
                   is_other = !is_first && entries[i].cell != entries[i - 1].cell;
        if (is_first || is_other || i - places->begins[places->block_count - 1] == FIT_BLOCK)
            places->begins[places->block_count++] = i;
    }
    places->begins[places->block_count] = places->count;
}

static void take_places(const sort_entry *entries, const double *uvw, const double *wanted,
                        const double *weights, const size_t *numbers, fit_places *places)
{
    for (size_t i = 0; i < places->count; i++) {
        const size_t from = entries[i].index;
        memcpy(places->uvw + 3 * i, uvw + 3 * from, 3 * sizeof *uvw);
        memcpy(places->wanted + 3 * i, wanted + 3 * from, 3 * sizeof *wanted);
        places->weights[i] = weights[from];
        places->numbers[i] = numbers ? numbers[from] : from;
    }
}

ffd_status ffd_fit_places_make(const fit_unknowns *unknowns, size_t count, const double *uvw,
                               const double *wanted, const double *weights, const size_t *numbers,
                               fit_places *places, ffd_error *error)
{
    sort_entry *const entries = ffd_alloc(count, sizeof *entries);
    ffd_status status;
    *places = (fit_places){.unknowns = unknowns,
                           .count = count,
                           .uvw = ffd_alloc(count, 3 * sizeof *uvw),
                           .wanted = ffd_alloc(count, 3 * sizeof *wanted),
                           .weights = ffd_alloc(count, sizeof *weights),
                           .numbers = ffd_alloc(count, sizeof *numbers),
                           .begins = ffd_alloc(count + 1, sizeof *places->begins)};
    TRY_END(entries && places->uvw && places->wanted && places->weights && places->numbers && places->begins
                ? FFD_OK
                : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++)
        entries[i] = (sort_entry){ffd_unknowns_cell(unknowns, uvw + 3 * i), i};
    qsort(entries, count, sizeof *entries, compare_entries);
    find_blocks(entries, places);
    take_places(entries, uvw, wanted, weights, numbers, places);
end:
    ffd_free(entries);
    return status;
}

void ffd_fit_places_free(fit_places *places)
{
    ffd_free(places->uvw);
    ffd_free(places->wanted);
    ffd_free(places->weights);
    ffd_free(places->numbers);
    ffd_free(places->begins);
    *places = (fit_places){0};
}

/* Memory of a block: the lower half of its own matrix, row by row. */
typedef struct block_room {
    double *entries; /* row * row */
    uint32_t *seen;
    double *row;
} block_room;

typedef struct normal_work {
    const fit_places *places;
    double factor;
    const band_matrix *band;
    block_room *rooms;
    atomic_bool is_late;
} normal_work;

/* Makes the matrix of the places of a block. */
static void make_block(void *context, size_t tile, size_t first, size_t last, int slot)
{
    normal_work *const work = context;
    const fit_places *const places = work->places;
    const size_t count = places->unknowns->row;
    const block_room *const room = &work->rooms[slot];
    (void)first, (void)last;
    if (ffd_deadline_passed())
        atomic_store(&work->is_late, true);
    if (atomic_load(&work->is_late))
        return;
    memset(room->entries, 0, count * count * sizeof *room->entries);
    ffd_unknowns_seen(places->unknowns, places->uvw + 3 * places->begins[tile], room->seen);
    for (size_t p = places->begins[tile]; p < places->begins[tile + 1]; p++) {
        ffd_unknowns_row(places->unknowns, places->uvw + 3 * p, room->row);
        for (size_t a = 0; a < count; a++) {
            const double share = places->weights[p] * room->row[a];
            double *const to = room->entries + count * a;
            for (size_t b = 0; b <= a; b++)
                to[b] += share * room->row[b];
        }
    }
}

/* Adds that matrix. A closed direction may have one unknown several times. */
static void add_block(void *context, size_t tile, size_t first, size_t last, int slot)
{
    normal_work *const work = context;
    const size_t count = work->places->unknowns->row;
    const block_room *const room = &work->rooms[slot];
    (void)tile, (void)first, (void)last;
    if (atomic_load(&work->is_late))
        return;
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b <= a; b++) {
            const uint32_t i = room->seen[a], j = room->seen[b];
            const double entry = work->factor * room->entries[count * a + b];
            *ffd_band_entry(work->band, i > j ? i : j, i > j ? j : i) += i == j && a != b ? 2 * entry : entry;
        }
}

static void free_rooms(block_room *rooms, int slots)
{
    for (int s = 0; rooms && s < slots; s++) {
        ffd_free(rooms[s].entries);
        ffd_free(rooms[s].seen);
        ffd_free(rooms[s].row);
    }
    ffd_free(rooms);
}

/* Returns NULL if memory runs out. */
static block_room *make_rooms(size_t count, int slots)
{
    block_room *const rooms = ffd_alloc_zero((size_t)slots, sizeof *rooms);
    bool is_whole = rooms;
    for (int s = 0; s < slots && is_whole; s++) {
        rooms[s].entries = ffd_alloc(count * count, sizeof *rooms[s].entries);
        rooms[s].seen = ffd_alloc(count, sizeof *rooms[s].seen);
        rooms[s].row = ffd_alloc(count, sizeof *rooms[s].row);
        is_whole = rooms[s].entries && rooms[s].seen && rooms[s].row;
    }
    if (is_whole)
        return rooms;
    free_rooms(rooms, slots);
    return NULL;
}

/* The matrices of blocks of high degree are large: one thread makes them. */
#define MOST_ROOM ((size_t)1 << 10)

ffd_status ffd_normal_add(const fit_places *places, double factor, int threads, const band_matrix *band,
                          ffd_error *error)
{
    const int used = places->unknowns->row > MOST_ROOM ? 1 : threads, slots = ffd_ordered_slots(used);
    normal_work work = {places, factor, band, make_rooms(places->unknowns->row, slots), false};
    const bool is_done =
        work.rooms && ffd_parallel_in_order(places->block_count, 1, used, make_block, add_block, &work);
    free_rooms(work.rooms, slots);
    return is_done ? ffd_deadline_check(error) : ffd_fail_memory(error);
}

void ffd_place_value(const fit_unknowns *unknowns, const double uvw[3], const double *x, double value[3])
{
    double row[LONGEST_ROW];
    uint32_t seen[LONGEST_ROW];
    ffd_unknowns_seen(unknowns, uvw, seen);
    ffd_unknowns_row(unknowns, uvw, row);
    value[0] = value[1] = value[2] = 0;
    for (size_t n = 0; n < unknowns->row; n++)
        for (size_t c = 0; c < 3; c++)
            value[c] += row[n] * x[3 * (size_t)seen[n] + c];
}

void ffd_normal_residual(const fit_places *places, double factor, const double *x, double *to)
{
    const fit_unknowns *const unknowns = places->unknowns;
    double row[LONGEST_ROW];
    uint32_t seen[LONGEST_ROW];
    for (size_t b = 0; b < places->block_count && !ffd_deadline_passed(); b++) {
        ffd_unknowns_seen(unknowns, places->uvw + 3 * places->begins[b], seen);
        for (size_t p = places->begins[b]; p < places->begins[b + 1]; p++) {
            double left[3];
            ffd_unknowns_row(unknowns, places->uvw + 3 * p, row);
            memcpy(left, places->wanted + 3 * p, sizeof left);
            for (size_t n = 0; n < unknowns->row && x; n++)
                for (size_t c = 0; c < 3; c++)
                    left[c] -= row[n] * x[3 * (size_t)seen[n] + c];
            for (size_t n = 0; n < unknowns->row; n++)
                for (size_t c = 0; c < 3; c++)
                    to[3 * (size_t)seen[n] + c] += factor * places->weights[p] * row[n] * left[c];
        }
    }
}
