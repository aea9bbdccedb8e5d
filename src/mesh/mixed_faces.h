/* mixed_faces.h - for formats: selects the faces whose vertices do not all have equal marks (mixed_faces of
   mesh_format). */
#ifndef FFD_MESH_MIXED_FACES_H
#define FFD_MESH_MIXED_FACES_H

#include "mesh/mesh.h"

/* Marks of the vertices of a document: planes with a byte for each vertex. */
struct vertex_marks {
    const uint8_t *bytes; /* borrowed */
    size_t planes, vertices;
};

/* Returns the first marked vertex that is not before `vertex`; marks->vertices if there is none. Unmarked
   vertices, the most common, are skipped eight at a time. */
size_t ffd_marks_next(const vertex_marks *marks, size_t vertex);

/* Returns whether vertices do not all have equal marks. Inline, because it is called for every face. */
static inline bool ffd_marks_differ(const vertex_marks *marks, const uint32_t *vertices, size_t count)
{
    const uint8_t *bytes = marks->bytes;
    for (size_t p = 0; p < marks->planes; p++, bytes += marks->vertices)
        for (size_t i = 1; i < count; i++)
            if (bytes[vertices[i]] != bytes[vertices[0]])
                return true;
    return false;
}

/* A list of faces: for each its number of corners, then the corners. All zeros: empty. The caller frees
   words. */
typedef struct face_list {
    uint32_t *words;
    size_t count, capacity;
    size_t pending; /* corners of the current face, after these words */
    size_t faces;
    bool failed; /* memory ran out; nothing more is added */
} face_list;

/* Adds a corner to the current face. */
void ffd_face_list_corner(face_list *list, uint32_t vertex);
/* Ends the current face; keeps it if its vertices do not all have equal marks. */
void ffd_face_list_end(face_list *list, const vertex_marks *marks);

/* Makes faces from count lists, in order. Sets vertex_count; the format fills positions. There is nothing to
   free after a failure. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_face_lists_join(const mesh_document *document, const face_list *lists, size_t count,
                               mesh_faces *faces, ffd_error *error);
/* The same with only the vertices of these faces, so that their positions occupy few pages. */
ffd_status ffd_face_lists_narrow(const mesh_document *document, const face_list *lists, size_t count,
                                 mesh_faces *faces, ffd_error *error);

#endif
