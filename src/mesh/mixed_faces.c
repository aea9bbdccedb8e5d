#include "mesh/mixed_faces.h"
#include "base/memory/memory.h"

/* Makes room for so many words. Returns false if the list has failed. */
static bool grow(face_list *list, size_t words)
{
    list->failed =
        list->failed || !ffd_grow((void **)&list->words, &list->capacity, words, sizeof *list->words);
    return !list->failed;
}

void ffd_face_list_corner(face_list *list, uint32_t vertex)
{
    const size_t at = list->count + 1 + list->pending; /* a word is left for their number */
    if (at >= list->capacity && !grow(list, at + 1))
        return;
    list->words[at] = vertex;
    list->pending++;
}

void ffd_face_list_end(face_list *list, const vertex_marks *marks)
{
    const size_t corners = list->pending;
    list->pending = 0;
    list->failed = list->failed || corners > UINT32_MAX;
    if (list->failed || corners == 0 || !ffd_marks_differ(marks, list->words + list->count + 1, corners))
        return;
    list->words[list->count] = (uint32_t)corners;
    list->count += 1 + corners;
    list->faces++;
}

static void fill_faces(const face_list *lists, size_t count, mesh_faces *faces)
{
    size_t face = 0, corner = 0;
    for (size_t l = 0; l < count; l++)
        for (size_t i = 0; i < lists[l].count;) {
            faces->start[face++] = corner;
            for (size_t left = lists[l].words[i++]; left > 0; left--)
                faces->corners[corner++] = lists[l].words[i++];
        }
    faces->start[face] = corner;
}

ffd_status ffd_face_lists_join(const mesh_document *document, const face_list *lists, size_t count,
                               mesh_faces *faces, ffd_error *error)
{
    size_t corners = 0;
    for (size_t l = 0; l < count; l++) {
        if (lists[l].failed)
            return ffd_fail_memory(error);
        faces->face_count += lists[l].faces;
        corners += lists[l].count - lists[l].faces;
    }
    const ffd_status status = ffd_mesh_faces_make(document, faces, corners, error);
    if (!status)
        fill_faces(lists, count, faces);
    return status;
}
