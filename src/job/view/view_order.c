/* view_order.c - which vertices of two files of one mesh are the same: the later file may list its parts in
   another order. */
#include "base/memory/memory.h"
#include "job/view/view.h"
#include <stdlib.h>

/* A part whose vertices are counted, and the number of the first. */
typedef struct counted_part {
    size_t owner, first, count;
} counted_part;

typedef struct part_list {
    counted_part *parts;
    size_t count;
} part_list;

static int compare(const void *left, const void *right)
{
    const counted_part *const a = left, *const b = right;
    if (a->owner != b->owner)
        return a->owner < b->owner ? -1 : 1;
    return a->first < b->first ? -1 : a->first > b->first;
}

/* Lists the parts that have vertices, those of one owner in a row. */
static bool list_parts(const mesh_document *document, part_list *list)
{
    size_t first = 0;
    *list = (part_list){.parts = ffd_alloc(document->part_count, sizeof *list->parts)};
    for (size_t i = 0; i < document->part_count && list->parts; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions || part->vertex_count == 0)
            continue;
        list->parts[list->count++] = (counted_part){part->owner, first, part->vertex_count};
        first += part->vertex_count;
    }
    if (list->count > 1)
        qsort(list->parts, list->count, sizeof *list->parts, compare);
    return list->parts;
}

/* Whether the parts of one list are those of the other; moved: and some stand elsewhere. */
static bool are_alike(const part_list *before, const part_list *after, bool *moved)
{
    *moved = false;
    if (before->count != after->count)
        return false;
    for (size_t i = 0; i < before->count; i++) {
        const counted_part *const a = &before->parts[i], *const b = &after->parts[i];
        if (a->owner != b->owner || a->count != b->count)
            return false;
        *moved = *moved || a->first != b->first;
    }
    return true;
}

static ffd_status make_order(const part_list *before, const part_list *after, mesh_document *document,
                             size_t **order, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    TRY(ffd_budget_take(&document->budget, count, sizeof **order, error));
    *order = ffd_alloc(count, sizeof **order);
    if (!*order)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < before->count; i++)
        for (size_t v = 0; v < before->parts[i].count; v++)
            (*order)[before->parts[i].first + v] = after->parts[i].first + v;
    return FFD_OK;
}

ffd_status ffd_view_match_parts(const mesh_document *before, mesh_document *after, size_t **order,
                                ffd_error *error)
{
    part_list of_before, of_after = {0};
    bool moved;
    ffd_status status;
    TRY_END(list_parts(before, &of_before) && list_parts(after, &of_after) ? FFD_OK : ffd_fail_memory(error));
    if (are_alike(&of_before, &of_after, &moved) && moved)
        TRY_END(make_order(&of_before, &of_after, after, order, error));
end:
    ffd_free(of_before.parts);
    ffd_free(of_after.parts);
    return status;
}
