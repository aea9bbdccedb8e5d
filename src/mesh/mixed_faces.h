/* mixed_faces.h - for formats: picks the faces whose vertices are not all marked alike (mesh_format's
   mixed_faces). */
#ifndef FFD_MESH_MIXED_FACES_H
#define FFD_MESH_MIXED_FACES_H

#include "mesh/mesh.h"

/* Marks of a document's vertices: planes of a byte for each. */
struct vertex_marks {
    const uint8_t *bytes; /* lent */
    size_t planes, vertices;
};

/* The first vertex from this one on that has a mark; marks->vertices: there is none. Most have none: they are
   passed over eight at a time. */
size_t ffd_marks_next(const vertex_marks *marks, size_t vertex);

/* Whether vertices are not all marked alike. Inline: it is asked of every face. */
static inline bool ffd_marks_differ(const vertex_marks *marks, const uint32_t *vertices, size_t count)
{
    const uint8_t *bytes = marks->bytes;
    for (size_t p = 0; p < marks->planes; p++, bytes += marks->vertices)
        for (size_t i = 1; i < count; i++)
            if (bytes[vertices[i]] != bytes[vertices[0]])
                return true;
    return false;
}

/* Faces, one after the other: the number of corners of each, then these. Begins as zeros; words is the
   caller's to free. */
typedef struct face_list {
    uint32_t *words;
    size_t count, capacity;
    size_t pending; /* corners behind these words, of the face that is being listed */
    size_t faces;
    bool failed; /* memory ran out: nothing is added any more */
} face_list;

/* Adds the next corner of a face. */
void ffd_face_list_corner(face_list *list, uint32_t vertex);
/* Ends the face, which is kept if its vertices are not all marked alike. */
void ffd_face_list_end(face_list *list, const vertex_marks *marks);

/* Makes the faces of count lists, in their order. vertex_count is set; positions are the format's to fill in.
   A failure leaves nothing to be freed. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_face_lists_join(const mesh_document *document, const face_list *lists, size_t count,
                               mesh_faces *faces, ffd_error *error);
/* The same, and leaves only the vertices of these faces: their positions are in few pages then. */
ffd_status ffd_face_lists_narrow(const mesh_document *document, const face_list *lists, size_t count,
                                 mesh_faces *faces, ffd_error *error);

#endif
