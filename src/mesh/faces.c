#include "base/memory.h"
#include "mesh/mesh.h"
#include <string.h>

ffd_status ffd_mesh_faces_make(mesh_faces *faces, size_t corners, ffd_error *error)
{
    faces->positions = ffd_alloc(faces->vertex_count, 3 * sizeof *faces->positions);
    faces->start = ffd_alloc(faces->face_count + 1, sizeof *faces->start);
    faces->corners = ffd_alloc(corners, sizeof *faces->corners);
    if (faces->positions && faces->start && faces->corners)
        return FFD_OK;
    ffd_mesh_faces_free(faces);
    return ffd_fail_memory(error);
}

void ffd_mesh_faces_free(mesh_faces *faces)
{
    ffd_free(faces->positions);
    ffd_free(faces->start);
    ffd_free(faces->corners);
    memset(faces, 0, sizeof *faces);
}
