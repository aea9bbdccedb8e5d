/* volume_compare.c - compares two volume meshes of one format.

   They are the same mesh if their points and normals are equal within the tolerances, their cells join the
   same points in the same order, and all other bytes of the files are the same. Cells in further files count
   where both meshes have them. */
#include "io/volume/volume_document.h"
#include "mesh/difference.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct comparer {
    const volume_document *a, *b;
    ffd_comparison *result;
    size_t vertex;
} comparer;

/* A difference_label. */
static void format_vertex(const void *context, char *text, size_t capacity)
{
    const comparer *const c = context;
    snprintf(text, capacity, "point %zu counted from 0", c->vertex);
}

/* Whether points and normals can be matched one by one. */
static bool is_same_form(comparer *c)
{
    const mesh_part *const a = &c->a->file.part, *const b = &c->b->file.part;
    if (strcmp(c->a->encoding, c->b->encoding) != 0)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_OTHER, "one is %s, the other %s", c->a->encoding,
                            c->b->encoding);
    if (a->vertex_count != b->vertex_count)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_TOPOLOGY, "%zu and %zu points", a->vertex_count,
                            b->vertex_count);
    if (a->normal_count != b->normal_count)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_OTHER, "normals are only in the %s",
                            a->normal_count ? "first" : "second");
    if (c->a->span_count != c->b->span_count)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_OTHER, "the points are in %zu and %zu pieces",
                            c->a->span_count, c->b->span_count);
    return c->result->equal;
}

static void compare_vectors(comparer *c)
{
    const file_document *const a = &c->a->file, *const b = &c->b->file;
    for (c->vertex = 0; c->vertex < a->part.vertex_count; c->vertex++) {
        const size_t at = 3 * c->vertex;
        ffd_difference_vector(c->result, FFD_DIFFERENCE_POSITION, 3, a->positions + at, b->positions + at,
                              format_vertex, c);
        if (a->directions)
            ffd_difference_vector(c->result, FFD_DIFFERENCE_NORMAL, 3, a->directions + at, b->directions + at,
                                  format_vertex, c);
        c->result->positions_compared++;
    }
}

static bool is_same_cell(const comparer *c, size_t cell)
{
    size_t count_a, count_b;
    const uint32_t *const a = ffd_cell_words(&c->a->cells, cell, &count_a);
    const uint32_t *const b = ffd_cell_words(&c->b->cells, cell, &count_b);
    return c->a->cells.kinds[cell] == c->b->cells.kinds[cell] && count_a == count_b &&
           (count_a == 0 || memcmp(a, b, count_a * sizeof *a) == 0);
}

/* Returns whether all cells that both have are the same. */
static bool compare_cells(comparer *c)
{
    if (c->a->lacks_cells || c->b->lacks_cells)
        return true;
    const size_t count = c->a->cells.count;
    bool same = count == c->b->cells.count;
    if (!same)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_TOPOLOGY, "%zu and %zu cells", count,
                            c->b->cells.count);
    for (size_t cell = 0; cell < count && cell < c->b->cells.count; cell++) {
        if (is_same_cell(c, cell))
            continue;
        same = false;
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_TOPOLOGY, "cell %zu counted from 0 differs", cell);
    }
    return same;
}

/* The bytes between two spans that may change. */
typedef struct between {
    const char *first, *last;
} between;

static between bytes_before(const volume_document *d, size_t span)
{
    const char *const data = (const char *)d->file.input.data;
    const char *const first = span ? d->spans[span - 1].last : data;
    const char *const last = span < d->span_count ? d->spans[span].first : data + d->file.input.size;
    return (between){first, last > first ? last : first};
}

static uint64_t common_bytes(between a, between b)
{
    const char *at = a.first;
    while (at < a.last && b.first < b.last && *at == *b.first) {
        at++;
        b.first++;
    }
    return (uint64_t)(at - a.first);
}

static void compare_bytes(comparer *c)
{
    for (size_t i = 0; i <= c->a->span_count; i++) {
        const between a = bytes_before(c->a, i), b = bytes_before(c->b, i);
        const uint64_t common = common_bytes(a, b);
        if (a.first + common == a.last && b.first + common == b.last)
            continue;
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER,
                                "other bytes differ, the first at byte %" PRIu64 " and byte %" PRIu64
                                " counted from 0",
                                (uint64_t)(a.first - (const char *)c->a->file.input.data) + common,
                                (uint64_t)(b.first - (const char *)c->b->file.input.data) + common);
    }
}

ffd_status ffd_volume_compare(const mesh_document *a, const mesh_document *b, ffd_comparison *comparison,
                              ffd_error *error)
{
    comparer c = {.a = ffd_volume_of(a), .b = ffd_volume_of(b), .result = comparison};
    (void)error;
    if (!is_same_form(&c))
        return FFD_OK;
    compare_vectors(&c);
    if (compare_cells(&c))
        compare_bytes(&c);
    return FFD_OK;
}
