#include "mesh/mesh.h"
#include "base/memory/memory.h"
#include <string.h>

#define BLOCK ((size_t)64)

void ffd_points_transform(const double *transforms, size_t count, double *points)
{
    for (size_t i = 0; i < count; i++)
        ffd_point_transform(transforms + 12 * i, transforms + 12 * i + 9, points + 3 * i);
}

static void place_skinned(const mesh_document *document, size_t part, size_t first, size_t count,
                          double *points)
{
    double transforms[12 * BLOCK];
    for (size_t at = 0; at < count; at += BLOCK) {
        const size_t size = count - at < BLOCK ? count - at : BLOCK;
        document->format->read_transforms(document, part, first + at, size, transforms, NULL);
        ffd_points_transform(transforms, size, points + 3 * at);
    }
}

void ffd_part_transform(const mesh_document *document, size_t part, size_t first, size_t count,
                        double *points)
{
    const mesh_part *p = &document->parts[part];
    if (p->skinned)
        place_skinned(document, part, first, count, points);
    for (size_t i = 0; i < count && !p->skinned && !p->identity; i++)
        ffd_point_transform(p->linear, p->offset, points + 3 * i);
}

bool ffd_mesh_shows_shapes(const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (document->parts[i].shows_shapes)
            return true;
    return false;
}

uint64_t ffd_mesh_vertex_count(const mesh_document *document)
{
    uint64_t count = 0;
    for (size_t i = 0; i < document->part_count; i++)
        if (!document->parts[i].repeats_positions)
            count += document->parts[i].vertex_count;
    return count;
}

ffd_status ffd_first_vertices(const mesh_document *document, size_t **first, ffd_error *error)
{
    size_t index = 0;
    *first = ffd_alloc(document->part_count, sizeof **first);
    if (!*first)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *part = &document->parts[i];
        (*first)[i] = part->repeats_positions ? (*first)[part->repeats] : index;
        index += part->repeats_positions ? 0 : part->vertex_count;
    }
    return FFD_OK;
}

ffd_status ffd_mesh_mark_used(mesh_document *document, ffd_error *error)
{
    if (document->used_is_marked || !document->format->mark_used)
        return FFD_OK;
    TRY(document->format->mark_used(document, error));
    document->used_is_marked = true;
    return FFD_OK;
}

ffd_status ffd_used_make(mesh_document *document, size_t count, uint8_t **used, ffd_error *error)
{
    TRY(ffd_budget_take(&document->budget, count, 1, error));
    *used = ffd_alloc_zero(count, 1);
    return *used ? FFD_OK : ffd_fail_memory(error);
}

bool ffd_used_keep(mesh_document *document, size_t count, uint8_t **used)
{
    size_t marked = 0;
    for (size_t i = 0; i < count; i++)
        marked += (*used)[i];
    if (marked > 0 && marked < count)
        return true;
    ffd_free(*used);
    *used = NULL;
    ffd_budget_return(&document->budget, count, 1);
    return false;
}

void ffd_mesh_describe_splats(const mesh_document *document, json_text *json)
{
    uint64_t count = 0;
    int degree = 0;
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (!part->splats || part->repeats_positions)
            continue;
        count += part->vertex_count;
        degree = part->form.degree > degree ? part->form.degree : degree;
    }
    if (count == 0)
        return;
    ffd_json_object(json, "gaussian_splats", true);
    ffd_json_count(json, "count", count);
    ffd_json_count(json, "sh_degree", (uint64_t)degree);
    ffd_json_end(json, '}');
}

ffd_status ffd_mesh_faces_take(const mesh_faces *faces, uint64_t corners, memory_budget *budget,
                               ffd_error *error)
{
    const size_t index = faces->vertices ? sizeof *faces->vertices : 0;
    TRY(ffd_budget_take(budget, faces->vertex_count, 3 * sizeof *faces->positions + index, error));
    TRY(ffd_budget_take(budget, faces->face_count, sizeof *faces->start, error));
    return ffd_budget_take(budget, corners, sizeof *faces->corners, error);
}

ffd_status ffd_mesh_faces_make(const mesh_document *document, mesh_faces *faces, size_t corners,
                               ffd_error *error)
{
    memory_budget budget = document->budget;
    ffd_status status;
    TRY_END(ffd_mesh_faces_take(faces, corners, &budget, error));
    faces->positions = ffd_alloc(faces->vertex_count, 3 * sizeof *faces->positions);
    faces->start = ffd_alloc(faces->face_count + 1, sizeof *faces->start);
    faces->corners = ffd_alloc(corners, sizeof *faces->corners);
    if (faces->positions && faces->start && faces->corners)
        return FFD_OK;
    TRY_END(ffd_fail_memory(error));
end:
    ffd_mesh_faces_free(faces);
    return status;
}

void ffd_mesh_faces_free(mesh_faces *faces)
{
    ffd_free(faces->positions);
    ffd_free(faces->start);
    ffd_free(faces->corners);
    ffd_free(faces->vertices);
    memset(faces, 0, sizeof *faces);
}
