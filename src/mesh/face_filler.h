/* face_filler.h - fills the faces of a mesh from a file that is read for a second time. Somebody may have
   changed the file in between, so that it has other faces than were counted. */
#ifndef FFD_MESH_FACE_FILLER_H
#define FFD_MESH_FACE_FILLER_H

#include "base/fail.h"
#include "mesh/mesh.h"

typedef struct face_filler {
    mesh_faces *faces;   /* allocated for the counted faces and corners */
    size_t corners;      /* capacity in corners */
    size_t face, corner; /* filled so far */
    bool ends; /* a number of faces or corners, or a vertex index, differs; or the deadline has passed */
} face_filler;

/* Begins the next face. */
void ffd_filler_face(face_filler *filler);
/* Adds a corner to the face. */
void ffd_filler_corner(face_filler *filler, size_t vertex);
/* Ends the last face. Fails with FFD_E_IO, and frees the faces, if their number differs from the capacity or
   a vertex index is out of range. */
ffd_status ffd_filler_end(face_filler *filler, const char *name, ffd_error *error);

/* Fails with FFD_E_IO and the message that the file has other faces than at first. */
ffd_status ffd_faces_changed(const char *name, ffd_error *error);

#endif
