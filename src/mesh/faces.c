/* faces.c - allocates and frees the arrays of mesh_faces. */
#include "base/memory/memory.h"
#include "mesh/mesh.h"
#include <string.h>

ffd_status ffd_mesh_faces_take(const mesh_faces *faces, uint64_t corners, memory_budget *budget,
                               ffd_error *error)
{
    const size_t number = faces->numbers ? sizeof *faces->numbers : 0;
    ffd_status status =
        ffd_budget_take(budget, faces->vertex_count, 3 * sizeof *faces->positions + number, error);
    if (status == FFD_OK)
        status = ffd_budget_take(budget, faces->face_count, sizeof *faces->start, error);
    return status == FFD_OK ? ffd_budget_take(budget, corners, sizeof *faces->corners, error) : status;
}

ffd_status ffd_mesh_faces_make(const mesh_document *document, mesh_faces *faces, size_t corners,
                               ffd_error *error)
{
    memory_budget budget = document->budget;
    ffd_status status = ffd_mesh_faces_take(faces, corners, &budget, error);
    if (status == FFD_OK) {
        faces->positions = ffd_alloc(faces->vertex_count, 3 * sizeof *faces->positions);
        faces->start = ffd_alloc(faces->face_count + 1, sizeof *faces->start);
        faces->corners = ffd_alloc(corners, sizeof *faces->corners);
        if (faces->positions && faces->start && faces->corners)
            return FFD_OK;
        status = ffd_fail_memory(error);
    }
    ffd_mesh_faces_free(faces);
    return status;
}

void ffd_mesh_faces_free(mesh_faces *faces)
{
    ffd_free(faces->positions);
    ffd_free(faces->start);
    ffd_free(faces->corners);
    ffd_free(faces->numbers);
    memset(faces, 0, sizeof *faces);
}
