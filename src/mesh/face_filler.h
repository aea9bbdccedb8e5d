/* face_filler.h - fills the faces of a mesh whose file is read a second time: in between somebody may have
   written to it, so that it has other faces than were counted. */
#ifndef FFD_MESH_FACE_FILLER_H
#define FFD_MESH_FACE_FILLER_H

#include "base/fail.h"
#include "mesh/mesh.h"

typedef struct face_filler {
    mesh_faces *faces;     /* made for this many faces and corners */
    size_t corners;        /* that there is room for */
    size_t face, corner;   /* filled so far */
    bool has_other_number; /* of faces, of corners or of a vertex */
} face_filler;

/* Begins the next face. */
void ffd_filler_face(face_filler *filler);
/* Adds a corner to it. */
void ffd_filler_corner(face_filler *filler, size_t vertex);
/* Ends the last face. Fails with FFD_E_IO, and frees the faces, if they are not as many as there is room for,
   or name a vertex that is not there. */
ffd_status ffd_filler_end(face_filler *filler, const char *name, ffd_error *error);

/* Fails with FFD_E_IO: a file that is read again has other faces than before. */
ffd_status ffd_faces_changed(const char *name, ffd_error *error);

#endif
