#include "job/measure/torn_edges.h"
#include "base/memory/memory.h"
#include <stdlib.h>

/* A key of the unordered pair. */
static uint64_t key_of(const torn_edge *edge)
{
    const uint64_t a = edge->ends[0], b = edge->ends[1];
    return a < b ? a << 32 | b : b << 32 | a;
}

static int compare_ends(const void *a, const void *b)
{
    const torn_edge *const x = a, *const y = b;
    const uint64_t s = key_of(x), t = key_of(y);
    if (s != t)
        return s < t ? -1 : 1;
    return x->step > y->step ? -1 : x->step < y->step;
}

static int compare_steps(const void *a, const void *b)
{
    const torn_edge *const x = a, *const y = b;
    return x->step > y->step ? -1 : x->step < y->step ? 1 : compare_ends(a, b);
}

void ffd_torn_edges_thin(torn_edges *torn)
{
    size_t kept = 0;
    if (torn->count == 0)
        return;
    qsort(torn->list, torn->count, sizeof *torn->list, compare_ends);
    for (size_t i = 0; i < torn->count; i++)
        if (kept == 0 || key_of(&torn->list[kept - 1]) != key_of(&torn->list[i]))
            torn->list[kept++] = torn->list[i];
    qsort(torn->list, kept, sizeof *torn->list, compare_steps);
    torn->count = kept < TORN_EDGES_MOST ? kept : TORN_EDGES_MOST;
}

ffd_status ffd_torn_edges_add(torn_edges *torn, uint32_t stays, uint32_t moves, double step, ffd_error *error)
{
    if (torn->count == 2 * TORN_EDGES_MOST)
        ffd_torn_edges_thin(torn);
    if (!ffd_grow((void **)&torn->list, &torn->capacity, torn->count + 1, sizeof *torn->list))
        return ffd_fail_memory(error);
    torn->list[torn->count++] = (torn_edge){{stays, moves}, step};
    return FFD_OK;
}
