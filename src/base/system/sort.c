#include "base/system/sort.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <stdlib.h>
#include <string.h>

/* Items that are sorted at once. */
#define RUN ((size_t)1 << 15)

typedef struct sorting {
    size_t count, size;
    int (*compare)(const void *, const void *);
} sorting;

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Merges the sorted items [first, middle) and [middle, end). */
static ffd_status merge(const sorting *s, const char *from, char *to, size_t first, size_t middle, size_t end,
                        ffd_error *error)
{
    size_t a = first, b = middle;
    for (size_t at = first; at < end; at++) {
        TRY(ffd_deadline_check_at(at, error));
        const char *const x = from + s->size * a, *const y = from + s->size * b;
        const bool takes_first = a < middle && (b == end || s->compare(x, y) <= 0);
        memcpy(to + s->size * at, takes_first ? x : y, s->size);
        a += takes_first;
        b += !takes_first;
    }
    return FFD_OK;
}

/* Returns with the sorted items in *items or, after an exchange, in what was *room. */
static ffd_status sort(const sorting *s, char **items, char **room, ffd_error *error)
{
    for (size_t first = 0; first < s->count; first += RUN) {
        TRY(ffd_deadline_check(error));
        qsort(*items + s->size * first, least(RUN, s->count - first), s->size, s->compare);
    }
    for (size_t width = RUN; width < s->count; width *= 2) {
        for (size_t first = 0; first < s->count; first += 2 * width)
            TRY(merge(s, *items, *room, first, least(first + width, s->count),
                      least(first + 2 * width, s->count), error));
        char *const sorted = *room;
        *room = *items;
        *items = sorted;
    }
    return FFD_OK;
}

ffd_status ffd_sort(void *items, size_t count, size_t size, int (*compare)(const void *, const void *),
                    ffd_error *error)
{
    const sorting s = {count, size, compare};
    char *const own = count > RUN ? ffd_alloc(count, size) : NULL;
    char *sorted = items, *room = own;
    if (count > RUN && !own)
        return ffd_fail_memory(error);
    const ffd_status status = sort(&s, &sorted, &room, error);
    if (!status && sorted == own)
        memcpy(items, own, size * count);
    ffd_free(own);
    return status;
}
