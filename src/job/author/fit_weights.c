/* fit_weights.c - how much a vertex counts: by the faces round it. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/author/fit_input.h"
#include "mesh/cell_list.h"
#include "mesh/positions.h"

/* The area of a face: of its projection to the plane that is nearest, which is right for one that is flat. */
static double area_of(const mesh_faces *faces, size_t face)
{
    const size_t first = faces->start[face], last = faces->start[face + 1];
    const double *const origin = faces->positions + 3 * (size_t)faces->corners[first];
    double sum[3] = {0, 0, 0}, before[3] = {0, 0, 0};
    for (size_t i = first + 1; i < last; i++) {
        const double *const place = faces->positions + 3 * (size_t)faces->corners[i];
        double side[3], cross[3];
        for (int c = 0; c < 3; c++)
            side[c] = place[c] - origin[c];
        vec_cross(before, side, cross);
        for (int c = 0; c < 3; c++) {
            sum[c] += cross[c];
            before[c] = side[c];
        }
    }
    const double area = vec_length(sum) / 2;
    return isfinite(area) ? area : 0;
}

/* Where a file lists a vertex for each corner, the faces have the first at a position: it shares its weight
   with the others. */
static ffd_status share(const mesh_faces *faces, double *weights, ffd_error *error)
{
    const size_t count = faces->vertex_count;
    uint32_t *const first = ffd_alloc(count, sizeof *first), *const sharing =
                                                                 ffd_alloc_zero(count, sizeof *sharing);
    position_table table = {0};
    ffd_status status;
    TRY_END(first && sharing ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_positions_begin(&table, faces->positions, count, error));
    for (size_t v = 0; v < count; v++) {
        first[v] = ffd_positions_add(&table, (uint32_t)v);
        sharing[first[v]]++;
    }
    for (size_t v = count; v-- > 0;) /* the first of a position is the last that is looked at */
        weights[v] = weights[first[v]] / sharing[first[v]];
end:
    ffd_positions_end(&table);
    ffd_free(first);
    ffd_free(sharing);
    return status;
}

ffd_status ffd_fit_area_weights(mesh_document *document, double *weights, bool *are_there, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    mesh_faces faces = {0};
    ffd_status status;
    *are_there = false;
    for (size_t v = 0; v < count; v++)
        weights[v] = 0;
    if (ffd_mesh_volumes(document) > 0)
        return FFD_OK; /* most vertices are on no outer face */
    TRY_END(document->format->faces(document, MESH_STORED, &faces, error));
    for (size_t f = 0; f < faces.face_count; f++) {
        const double part = area_of(&faces, f) / 3;
        *are_there = *are_there || part > 0;
        for (size_t i = faces.start[f]; i < faces.start[f + 1]; i++)
            weights[ffd_faces_document_vertex(&faces, faces.corners[i])] += part;
    }
    if (faces.repeated > 0 && faces.vertex_count == count && !faces.vertices)
        TRY_END(share(&faces, weights, error));
end:
    ffd_mesh_faces_free(&faces);
    return status;
}
