#include "mesh/face_filler.h"
#include "base/system/deadline.h"

void ffd_filler_face(face_filler *filler)
{
    if (filler->face < filler->faces->face_count && !ffd_deadline_passed_at(filler->face))
        filler->faces->start[filler->face++] = filler->corner;
    else
        filler->ends = true;
}

void ffd_filler_corner(face_filler *filler, size_t vertex)
{
    if (filler->corner < filler->corners && vertex < filler->faces->vertex_count)
        filler->faces->corners[filler->corner++] = (uint32_t)vertex;
    else
        filler->ends = true;
}

ffd_status ffd_filler_end(face_filler *filler, const char *name, ffd_error *error)
{
    mesh_faces *const faces = filler->faces;
    if (!filler->ends && filler->face == faces->face_count && filler->corner == filler->corners) {
        faces->start[filler->face] = filler->corner;
        return FFD_OK;
    }
    ffd_mesh_faces_free(faces);
    TRY(ffd_deadline_check(error));
    return ffd_faces_changed(name, error);
}

ffd_status ffd_faces_changed(const char *name, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_IO, name, "has changed while it was read: it has other faces now");
}
