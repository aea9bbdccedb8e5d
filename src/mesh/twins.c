#include "mesh/twins.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include <string.h>

/* Vertices that are looked at at a time. */
#define TILE ((size_t)1 << 14)
/* Words of bits that are joined at a time. */
#define WORDS ((size_t)1 << 13)
/* Vertices whose bits are fetched together. */
#define FETCHED ((size_t)32)
/* Bits for each vertex, at least: as many as the nearer caches hold. One in nine vertices shares its bit with
   another one by chance. */
#define SPARSENESS 8

/* All bits of a coordinate reach the upper half. */
static uint32_t hash_position(const double position[3])
{
    static const uint64_t factors[3] = {UINT64_C(0x9e3779b97f4a7c15), UINT64_C(0xbf58476d1ce4e5b9),
                                        UINT64_C(0x94d049bb133111eb)};
    uint64_t hash = 0;
    for (int a = 0; a < 3; a++) {
        const double coordinate = position[a] + 0.0;
        uint64_t bits;
        memcpy(&bits, &coordinate, sizeof bits);
        hash += (bits ^ bits >> 32) * factors[a];
    }
    return (uint32_t)(((hash ^ hash >> 32) * factors[0]) >> 32);
}

static bool has(const uint64_t *bits, uint32_t bit)
{
    return bits[bit / 64] >> bit % 64 & 1;
}

static void set(uint64_t *bits, uint32_t bit)
{
    bits[bit / 64] |= UINT64_C(1) << bit % 64;
}

/* Clears the bits of a worker. Pages that are read before they are written cost twice, and stop the other
   cores. */
static void clear_bits(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const repeat_filter *const filter = context;
    (void)tile, (void)worker;
    memset(filter->seen[first], 0, 2 * (last - first) * filter->words * sizeof(uint64_t));
}

ffd_status ffd_repeats_begin(repeat_filter *filter, size_t count, int threads, void *room, size_t room_size,
                             ffd_error *error)
{
    int bits = 6;
    while (bits < 32 && (uint64_t)1 << bits < (uint64_t)count * SPARSENESS)
        bits++;
    *filter = (repeat_filter){.count = count, .shift = 32 - bits, .words = (size_t)1 << (bits - 6)};
    filter->workers = ffd_threads_for(threads, count / TILE + 1);
    if (filter->workers > REPEAT_WORKERS)
        filter->workers = REPEAT_WORKERS;
    const size_t words = 2 * (size_t)filter->workers * filter->words;
    const size_t needed = words * sizeof(uint64_t) + count * sizeof *filter->hashes;
    const bool fits = room && room_size >= needed;
    filter->own = fits ? NULL : ffd_alloc_whole(needed, 1);
    if (!fits && !filter->own)
        return ffd_fail_memory(error);
    uint64_t *const sets = fits ? room : filter->own;
    filter->hashes = (uint32_t *)(sets + words);
    for (int w = 0; w < filter->workers; w++) {
        filter->seen[w] = sets + 2 * (size_t)w * filter->words;
        filter->again[w] = filter->seen[w] + filter->words;
    }
    ffd_parallel_tiles((size_t)filter->workers, 1, filter->workers, clear_bits, filter);
    return FFD_OK;
}

void ffd_repeats_end(repeat_filter *filter)
{
    ffd_free(filter->own);
    *filter = (repeat_filter){0};
}

/* Adds at most FETCHED vertices: their bits are anywhere, and take long to come one by one. */
static void add_some(const repeat_filter *filter, size_t first, size_t count, const double *positions,
                     int worker)
{
    uint64_t *const seen = filter->seen[worker], *const again = filter->again[worker];
    uint32_t *const hashes = filter->hashes + first;
    for (size_t i = 0; i < count; i++) {
        hashes[i] = hash_position(positions + 3 * i);
        __builtin_prefetch(&seen[(hashes[i] >> filter->shift) / 64], 1);
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t bit = hashes[i] >> filter->shift;
        if (has(seen, bit))
            set(again, bit);
        set(seen, bit);
    }
}

void ffd_repeats_add(const repeat_filter *filter, size_t first, size_t count, const double *positions,
                     int worker)
{
    for (size_t from = 0, some; from < count; from += some) {
        some = count - from < FETCHED ? count - from : FETCHED;
        add_some(filter, first + from, some, positions + 3 * from, worker);
    }
}

/* Joins what the workers have seen: a bit that two of them have is seen again. */
static void join_words(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const repeat_filter *const filter = context;
    (void)tile, (void)worker;
    for (size_t i = first; i < last; i++) {
        uint64_t seen = 0, again = 0;
        for (int w = 0; w < filter->workers; w++) {
            again |= filter->again[w][i] | (seen & filter->seen[w][i]);
            seen |= filter->seen[w][i];
        }
        filter->again[0][i] = again;
    }
}

/* A list that is made of tiles. */
typedef struct list_work {
    const repeat_filter *filter;
    uint64_t *repeated; /* a bit for each vertex */
    size_t *counts;     /* of each tile; then where its entries begin */
    uint32_t *list;
} list_work;

_Static_assert(TILE % 64 == 0, "a word of bits is of one tile");

static void count_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const list_work *const work = context;
    const repeat_filter *const filter = work->filter;
    size_t count = 0;
    (void)worker;
    for (size_t from = first; from < last; from += 64) {
        uint64_t bits = 0;
        for (size_t v = from; v < last && v < from + 64; v++)
            bits |= (uint64_t)has(filter->again[0], filter->hashes[v] >> filter->shift) << (v - from);
        work->repeated[from / 64] = bits;
        count += (size_t)__builtin_popcountll(bits);
    }
    work->counts[tile] = count;
}

static void list_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const list_work *const work = context;
    size_t at = work->counts[tile];
    (void)worker;
    for (size_t from = first; from < last; from += 64)
        for (uint64_t bits = work->repeated[from / 64]; bits; bits &= bits - 1)
            work->list[at++] = (uint32_t)(from + (size_t)__builtin_ctzll(bits));
}

/* Drops most of those that are listed by chance, by other bits of their hashes. */
static ffd_status thin_out(const repeat_filter *filter, uint32_t *list, size_t *found, ffd_error *error)
{
    const uint32_t factor = 0x9e3779b1;
    size_t kept = 0;
    int bits = 6;
    while (bits < 32 && (uint64_t)1 << bits < (uint64_t)*found * SPARSENESS)
        bits++;
    uint64_t *const seen = ffd_alloc_zero((size_t)1 << (bits - 6), 2 * sizeof *seen);
    if (!seen)
        return ffd_fail_memory(error);
    uint64_t *const again = seen + ((size_t)1 << (bits - 6));
    for (size_t k = 0; k < *found; k++) {
        const uint32_t bit = filter->hashes[list[k]] * factor >> (32 - bits);
        if (has(seen, bit))
            set(again, bit);
        set(seen, bit);
    }
    for (size_t k = 0; k < *found; k++)
        if (has(again, filter->hashes[list[k]] * factor >> (32 - bits)))
            list[kept++] = list[k];
    *found = kept;
    ffd_free(seen);
    return ffd_deadline_check(error);
}

ffd_status ffd_repeats_list(repeat_filter *filter, uint32_t **list, size_t *found, ffd_error *error)
{
    const size_t tiles = filter->count / TILE + 1;
    list_work work = {.filter = filter,
                      .repeated = ffd_alloc(tiles, TILE / 64 * sizeof *work.repeated),
                      .counts = ffd_alloc_zero(tiles, sizeof *work.counts)};
    ffd_status status;
    *found = 0;
    TRY_END(work.repeated && work.counts ? FFD_OK : ffd_fail_memory(error));
    ffd_parallel_tiles(filter->words, WORDS, filter->workers, join_words, filter);
    ffd_parallel_tiles(filter->count, TILE, filter->workers, count_tile, &work);
    for (size_t t = 0; t < tiles; t++) {
        const size_t own = work.counts[t];
        work.counts[t] = *found;
        *found += own;
    }
    work.list = ffd_alloc(*found, sizeof *work.list);
    TRY_END(work.list ? FFD_OK : ffd_fail_memory(error));
    ffd_parallel_tiles(filter->count, TILE, filter->workers, list_tile, &work);
    TRY_END(thin_out(filter, work.list, found, error));
end:
    ffd_free(work.repeated);
    ffd_free(work.counts);
    if (status) {
        ffd_free(work.list);
        work.list = NULL;
    }
    *list = work.list;
    return status;
}

/* NaNs of the same bits are equal too. */
static bool are_equal(const double a[3], const double b[3])
{
    double x[3], y[3];
    for (int c = 0; c < 3; c++) {
        x[c] = a[c] + 0.0;
        y[c] = b[c] + 0.0;
    }
    return memcmp(x, y, sizeof x) == 0;
}

ffd_status ffd_leaders_find(const repeat_filter *filter, const double *positions, const uint32_t *list,
                            size_t count, uint32_t *leaders, ffd_error *error)
{
    const uint32_t *const hashes = filter->hashes;
    size_t mask;
    uint32_t *const slots = ffd_slots_make(count, sizeof *slots, &mask);
    if (!slots)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < count && !ffd_deadline_passed_at(k); k++) {
        const uint32_t hash = hashes[list[k]];
        size_t at = hash & mask;
        for (; slots[at] != UINT32_MAX; at = (at + 1) & mask)
            if (hashes[list[slots[at]]] == hash &&
                (!positions || are_equal(positions + 3 * (size_t)slots[at], positions + 3 * k)))
                break;
        slots[at] = slots[at] == UINT32_MAX ? (uint32_t)k : slots[at];
        leaders[k] = slots[at];
    }
    ffd_free(slots);
    return ffd_deadline_check(error);
}

/* Positions in memory, and their filter. */
typedef struct twin_work {
    const double *positions;
    const repeat_filter *filter;
    uint32_t *twins;
} twin_work;

static void add_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const twin_work *const work = context;
    (void)tile;
    ffd_repeats_add(work->filter, first, last - first, work->positions + 3 * first, worker);
    for (size_t v = first; v < last; v++)
        work->twins[v] = (uint32_t)v;
}

static bool have_twins(const uint32_t *leaders, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (leaders[k] != k)
            return true;
    return false;
}

ffd_status ffd_twins_find(const repeat_filter *filter, const double *places, const uint32_t *list,
                          size_t count, uint32_t **twins, ffd_error *error)
{
    uint32_t *const leaders = ffd_alloc(count, sizeof *leaders);
    ffd_status status;
    *twins = NULL;
    TRY_END(leaders ? ffd_leaders_find(filter, places, list, count, leaders, error) : ffd_fail_memory(error));
    if (!have_twins(leaders, count))
        goto end;
    *twins = ffd_alloc_whole(filter->count, sizeof **twins);
    TRY_END(*twins ? FFD_OK : ffd_fail_memory(error));
    for (size_t v = 0; v < filter->count; v++)
        (*twins)[v] = (uint32_t)v;
    for (size_t k = 0; k < count; k++)
        (*twins)[list[k]] = list[leaders[k]];
end:
    ffd_free(leaders);
    return status;
}

ffd_status ffd_positions_twins(const double *positions, size_t count, int threads, uint32_t *twins,
                               ffd_error *error)
{
    repeat_filter filter;
    twin_work work = {positions, &filter, twins};
    uint32_t *list = NULL, *leaders = NULL;
    double *places = NULL;
    size_t found;
    ffd_status status;
    TRY_END(ffd_repeats_begin(&filter, count, threads, NULL, 0, error));
    ffd_parallel_tiles(count, TILE, filter.workers, add_tile, &work);
    TRY_END(ffd_deadline_check(error));
    TRY_END(ffd_repeats_list(&filter, &list, &found, error));
    leaders = ffd_alloc(found, sizeof *leaders);
    places = ffd_alloc(found, 3 * sizeof *places);
    TRY_END(leaders && places ? FFD_OK : ffd_fail_memory(error));
    for (size_t k = 0; k < found; k++)
        memcpy(places + 3 * k, positions + 3 * (size_t)list[k], 3 * sizeof *places);
    TRY_END(ffd_leaders_find(&filter, places, list, found, leaders, error));
    for (size_t k = 0; k < found; k++)
        twins[list[k]] = list[leaders[k]];
end:
    ffd_free(list);
    ffd_free(places);
    ffd_free(leaders);
    ffd_repeats_end(&filter);
    return status;
}
