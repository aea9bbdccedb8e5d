#include "base/memory.h"
#include "mesh/mesh.h"
#include <string.h>

void ffd_mesh_faces_free(mesh_faces *faces)
{
    ffd_free(faces->positions);
    ffd_free(faces->start);
    ffd_free(faces->corners);
    memset(faces, 0, sizeof *faces);
}
