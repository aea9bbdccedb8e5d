/* foam_cells.c - cells as polyhedra, and the outer faces. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/foam/foam_mesh.h"
#include <inttypes.h>
#include <string.h>

/* The faces of each cell, in the order of the file. */
typedef struct cell_sides {
    size_t *ends; /* cells */
    uint32_t *faces;
    size_t cells;
} cell_sides;

/* Counts the cells and their faces: ends[c] becomes that of cell c - 1. */
static ffd_status count_sides(const foam_reader *r, cell_sides *sides)
{
    const foam_labels *const lists[] = {&r->owner, &r->neighbour};
    const char *const file = r->d->volume.file.name;
    uint32_t largest = 0;
    for (size_t l = 0; l < 2; l++)
        for (size_t i = 0; i < lists[l]->count; i++)
            largest = lists[l]->values[i] > largest ? lists[l]->values[i] : largest;
    sides->cells = r->owner.count ? (size_t)largest + 1 : 0;
    if (sides->cells > r->owner.count + r->neighbour.count)
        return ffd_fail_file(r->error, FFD_E_INVALID, file,
                             "owner and neighbour beside it have the cell %" PRIu32
                             ", but there are only %zu faces",
                             largest, r->owner.count);
    sides->ends = ffd_alloc_zero(sides->cells + 1, sizeof *sides->ends);
    sides->faces = ffd_alloc(r->owner.count + r->neighbour.count, sizeof *sides->faces);
    if (!sides->ends || !sides->faces)
        return ffd_fail_memory(r->error);
    for (size_t l = 0; l < 2; l++)
        for (size_t i = 0; i < lists[l]->count; i++)
            sides->ends[lists[l]->values[i] + 1]++;
    for (size_t c = 0; c < sides->cells; c++)
        sides->ends[c + 1] += sides->ends[c];
    return FFD_OK;
}

/* Lists the faces of each cell. */
static ffd_status list_sides(const foam_reader *r, cell_sides *sides)
{
    TRY(count_sides(r, sides));
    for (size_t f = 0; f < r->owner.count; f++) {
        sides->faces[sides->ends[r->owner.values[f]]++] = (uint32_t)f;
        if (f >= r->neighbour.count)
            continue;
        if (r->neighbour.values[f] == r->owner.values[f])
            return ffd_fail_file(r->error, FFD_E_INVALID, r->d->volume.file.name,
                                 "owner and neighbour beside it have the cell %" PRIu32
                                 " on both sides of face %zu",
                                 r->owner.values[f], f);
        sides->faces[sides->ends[r->neighbour.values[f]]++] = (uint32_t)f;
    }
    return FFD_OK;
}

/* Adds the corners of a face as the cell sees it from outside. */
static ffd_status add_face(foam_reader *r, size_t face, bool is_own)
{
    volume_cells *const cells = &r->d->volume.cells;
    size_t count;
    const uint32_t *const corners = foam_corners(&r->faces, face, &count);
    TRY(ffd_cells_word(cells, (uint32_t)count, r->error));
    for (size_t c = 0; c < count; c++)
        TRY(ffd_cells_word(cells, corners[is_own ? c : count - 1 - c], r->error));
    return FFD_OK;
}

static ffd_status add_cells(foam_reader *r, const cell_sides *sides)
{
    volume_document *const d = &r->d->volume;
    size_t at = 0;
    for (size_t c = 0; c < sides->cells; c++) {
        TRY(ffd_deadline_check_at(c, r->error));
        TRY(ffd_cells_word(&d->cells, (uint32_t)(sides->ends[c] - at), r->error));
        for (; at < sides->ends[c]; at++)
            TRY(add_face(r, sides->faces[at], r->owner.values[sides->faces[at]] == c));
        TRY(ffd_cells_end(&d->cells, CELL_POLYHEDRON, d->file.part.vertex_count, r->error));
    }
    return FFD_OK;
}

/* Copies the faces that only one cell has. */
static ffd_status copy_outer(foam_reader *r)
{
    const foam_faces *const faces = &r->faces;
    volume_outer *const outer = &r->d->volume.outer;
    const size_t first = faces->inner ? faces->ends[faces->inner - 1] : 0;
    const size_t corners = faces->corners.count - first;
    outer->ends = ffd_alloc(faces->count - faces->inner, sizeof *outer->ends);
    outer->corners = ffd_alloc(corners, sizeof *outer->corners);
    if (!outer->ends || !outer->corners)
        return ffd_fail_memory(r->error);
    outer->count = faces->count - faces->inner;
    for (size_t f = 0; f < outer->count; f++)
        outer->ends[f] = faces->ends[faces->inner + f] - first;
    if (corners)
        memcpy(outer->corners, faces->corners.values + first, corners * sizeof *outer->corners);
    return FFD_OK;
}

ffd_status ffd_foam_make_cells(foam_reader *r)
{
    volume_document *const d = &r->d->volume;
    const bool *const is_there = r->d->is_there;
    cell_sides sides = {0};
    ffd_status status = FFD_OK;
    d->listed_faces = r->faces.count;
    d->has_outer = is_there[FOAM_FACES] && r->faces.inner <= r->faces.count;
    if (d->has_outer)
        TRY_END(copy_outer(r));
    d->lacks_cells = !d->has_outer || !is_there[FOAM_OWNER] || r->faces.inner != r->neighbour.count;
    if (d->lacks_cells)
        goto end;
    TRY_END(list_sides(r, &sides));
    TRY_END(add_cells(r, &sides));
end:
    ffd_free(sides.ends);
    ffd_free(sides.faces);
    return status;
}
