#include "picture/bands.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"

/* Consecutive items that one thread processes: a share, which has its own counts. */
#define LEAST_SHARE ((size_t)1 << 16)
#define MOST_SHARES 64

/* A range of bands is packed as the first and the last band, 16 bits each; NO_BAND: none. */
#define NO_BAND UINT32_MAX

typedef struct band_work {
    int64_t top, bottom;
    band_rows rows;
    const void *context;
    bands *result;
    size_t *next;     /* for each share and band: the number of items, then the position of the next one */
    uint32_t *ranges; /* band range of each item, so that it is computed once */
} band_work;

static uint32_t range_of(const band_work *work, size_t item)
{
    int64_t first, last;
    if (!work->rows(work->context, item, &first, &last) || last < work->top || first >= work->bottom)
        return NO_BAND;
    first = first < work->top ? work->top : first;
    last = last >= work->bottom ? work->bottom - 1 : last;
    return (uint32_t)((first - work->top) / BAND_ROWS) | (uint32_t)((last - work->top) / BAND_ROWS) << 16;
}

static void count_items(void *context, size_t share, size_t begin, size_t end, int worker)
{
    const band_work *const work = context;
    size_t *const next = work->next + share * work->result->count;
    (void)worker;
    for (size_t i = begin; i < end; i++) {
        const uint32_t range = work->ranges[i] = range_of(work, i);
        for (uint32_t band = range & 0xffff; range != NO_BAND && band <= range >> 16; band++)
            next[band]++;
    }
}

static void list_items(void *context, size_t share, size_t begin, size_t end, int worker)
{
    const band_work *const work = context;
    size_t *const next = work->next + share * work->result->count;
    (void)worker;
    for (size_t i = begin; i < end; i++) {
        const uint32_t range = work->ranges[i];
        for (uint32_t band = range & 0xffff; range != NO_BAND && band <= range >> 16; band++)
            work->result->items[next[band]++] = (uint32_t)i;
    }
}

/* Converts counts to positions: sorted by band, within a band by share. */
static size_t place(const band_work *work, size_t shares)
{
    size_t sum = 0;
    for (size_t band = 0; band < work->result->count; band++) {
        work->result->starts[band] = sum;
        for (size_t share = 0; share < shares; share++) {
            size_t *const next = &work->next[share * work->result->count + band];
            const size_t count = *next;
            *next = sum;
            sum += count;
        }
    }
    work->result->starts[work->result->count] = sum;
    return sum;
}

static ffd_status fill(band_work *work, size_t count, size_t share, const band_means *means, ffd_error *error)
{
    ffd_parallel_tiles(count, share, means->threads, count_items, work);
    const size_t total = place(work, count / share + 1);
    TRY(means->budget ? ffd_budget_take(means->budget, total, sizeof *work->result->items, error) : FFD_OK);
    work->result->items = ffd_alloc(total, sizeof *work->result->items);
    if (!work->result->items)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, share, means->threads, list_items, work);
    return FFD_OK;
}

ffd_status ffd_bands_make(int64_t top, int64_t bottom, size_t count, band_rows rows, const void *context,
                          const band_means *means, bands *result, ffd_error *error)
{
    const size_t least = count / MOST_SHARES + 1, share = least > LEAST_SHARE ? least : LEAST_SHARE;
    *result = (bands){.count = (size_t)(bottom - top + BAND_ROWS - 1) / BAND_ROWS};
    band_work work = {.top = top, .bottom = bottom, .rows = rows, .context = context, .result = result};
    result->starts = ffd_alloc_zero(result->count + 1, sizeof *result->starts);
    work.next = ffd_alloc_zero((count / share + 1) * result->count, sizeof *work.next);
    work.ranges = ffd_alloc(count, sizeof *work.ranges);
    const ffd_status status = result->starts && work.next && work.ranges
                                  ? fill(&work, count, share, means, error)
                                  : ffd_fail_memory(error);
    ffd_free(work.next);
    ffd_free(work.ranges);
    if (status)
        ffd_bands_free(result);
    return status;
}

void ffd_bands_free(bands *of)
{
    ffd_free(of->starts);
    ffd_free(of->items);
    *of = (bands){.count = 0};
}
