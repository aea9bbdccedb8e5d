#include "job/measure/edge_list.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <string.h>

#define DIGITS 8 /* bytes of a key */
#define RADIX 256

static size_t list_sides(const mesh_faces *faces, uint64_t *keys)
{
    size_t count = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const size_t first = faces->start[f], end = faces->start[f + 1];
        for (size_t c = first; c < end; c++) {
            const uint64_t a = faces->corners[c], b = faces->corners[c + 1 < end ? c + 1 : first];
            if (a != b)
                keys[count++] = a < b ? a << 32 | b : b << 32 | a;
        }
    }
    return count;
}

/* LSD radix sort by bytes; skips a byte that all keys share, and ends at the deadline. Returns the array that
   is sorted: keys or scratch. */
static uint64_t *radix_sort(uint64_t *keys, uint64_t *scratch, size_t count)
{
    size_t histogram[DIGITS][RADIX];
    memset(histogram, 0, sizeof histogram);
    for (size_t i = 0; i < count; i++)
        for (int d = 0; d < DIGITS; d++)
            histogram[d][keys[i] >> (8 * d) & (RADIX - 1)]++;
    for (int d = 0; d < DIGITS && count && !ffd_deadline_passed(); d++) {
        size_t next[RADIX], sum = 0;
        if (histogram[d][keys[0] >> (8 * d) & (RADIX - 1)] == count)
            continue;
        for (int digit = 0; digit < RADIX; digit++) {
            next[digit] = sum;
            sum += histogram[d][digit];
        }
        for (size_t i = 0; i < count; i++)
            scratch[next[keys[i] >> (8 * d) & (RADIX - 1)]++] = keys[i];
        uint64_t *const sorted = scratch;
        scratch = keys;
        keys = sorted;
    }
    return keys;
}

static size_t drop_repeats(uint64_t *keys, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || keys[i] != keys[kept - 1])
            keys[kept++] = keys[i];
    return kept;
}

ffd_status ffd_edges_sort(edge_list *edges, ffd_error *error)
{
    uint64_t *const scratch = ffd_alloc(edges->count, sizeof *scratch);
    if (!scratch)
        return ffd_fail_memory(error);
    uint64_t *const sorted = radix_sort(edges->keys, scratch, edges->count);
    ffd_free(sorted == edges->keys ? scratch : edges->keys);
    *edges = (edge_list){sorted, drop_repeats(sorted, edges->count)};
    return ffd_deadline_check(error);
}

ffd_status ffd_edges_collect(const mesh_faces *faces, edge_list *edges, ffd_error *error)
{
    const size_t corners = faces->face_count ? faces->start[faces->face_count] : 0;
    *edges = (edge_list){ffd_alloc(corners, sizeof *edges->keys), 0};
    if (!edges->keys)
        return ffd_fail_memory(error);
    edges->count = list_sides(faces, edges->keys);
    const ffd_status status = ffd_edges_sort(edges, error);
    if (status)
        ffd_edges_free(edges);
    return status;
}

void ffd_edges_free(edge_list *edges)
{
    ffd_free(edges->keys);
    *edges = (edge_list){NULL, 0};
}
