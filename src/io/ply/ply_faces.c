/* ply_faces.c - checks the faces of a PLY file, and passes them on. */
#include "base/memory/memory.h"
#include "io/ply/ply_plain_faces.h"
#include "io/ply/ply_strips.h"
#include "mesh/face_filler.h"
#include "mesh/mixed_faces.h"
#include <string.h>

typedef struct face_reader {
    const ply_document *document;
    ply_walk walk;
    mesh_faces *faces; /* NULL: the corners are only visited */
    uint8_t *used;     /* a byte per vertex, set for vertices of faces; or NULL */
    face_list *mixed;  /* gets the faces whose vertices have different marks; or NULL */
    const vertex_marks *marks;
    size_t face_count; /* so far */
    size_t corners, capacity;
    ffd_error *error;
} face_reader;

/* Begins a face with count corners. Returns false if memory ran out. */
static bool begin_face(face_reader *r, size_t count)
{
    if (r->faces &&
        !ffd_grow((void **)&r->faces->corners, &r->capacity, r->corners + count, sizeof *r->faces->corners))
        return false;
    /* The file may have changed since the faces were counted. */
    if (r->faces && r->face_count < r->faces->face_count)
        r->faces->start[r->face_count] = r->corners;
    r->face_count++;
    return true;
}

static void add_corner(face_reader *r, uint32_t vertex)
{
    if (r->faces)
        r->faces->corners[r->corners] = vertex;
    if (r->used)
        r->used[vertex] = 1;
    if (r->mixed)
        ffd_face_list_corner(r->mixed, vertex);
    r->corners++;
}

static void end_face(const face_reader *r)
{
    if (r->mixed)
        ffd_face_list_end(r->mixed, r->marks);
}

static bool take_triangle(void *context, const uint32_t corners[3])
{
    face_reader *const r = context;
    if (!begin_face(r, 3))
        return false;
    for (int i = 0; i < 3; i++)
        add_corner(r, corners[i]);
    end_face(r);
    return true;
}

/* Takes a whole face, like begin_face, add_corner and end_face. Returns false if memory ran out. */
static bool take_plain(face_reader *r, const uint32_t *corners, size_t count)
{
    if (!begin_face(r, count))
        return false;
    if (r->faces && count > 0)
        memcpy(r->faces->corners + r->corners, corners, count * sizeof *corners);
    for (size_t i = 0; i < count && r->used; i++)
        r->used[corners[i]] = 1;
    if (r->mixed && ffd_marks_differ(r->marks, corners, count)) {
        for (size_t i = 0; i < count; i++)
            ffd_face_list_corner(r->mixed, corners[i]);
        ffd_face_list_end(r->mixed, r->marks);
    }
    r->corners += count;
    return true;
}

static ffd_status read_corners(face_reader *r, uint64_t face)
{
    const ply_document *d = r->document;
    const ply_property *list = d->face_corners;
    text_word word;
    size_t count;
    if (!ffd_ply_walk_list(&r->walk, list, &word, &count))
        return ffd_faces_changed(d->file.name, r->error);
    if (!begin_face(r, count))
        return ffd_fail_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        size_t vertex;
        if (!ffd_ply_walk_count(&r->walk, list->type, &word, &vertex) || vertex >= d->file.part.vertex_count)
            return ffd_ply_refuse_vertex(r->document, &r->walk, "face", face, r->document->face_corners->type,
                                         word, r->error);
        add_corner(r, (uint32_t)vertex);
    }
    end_face(r);
    return FFD_OK;
}

static ffd_status read_face(face_reader *r, uint64_t face)
{
    const ply_element *element = r->document->face;
    ffd_status status = FFD_OK;
    ffd_ply_walk_row(&r->walk);
    for (size_t i = 0; status == FFD_OK && i < element->property_count; i++) {
        const ply_property *property = &element->properties[i];
        if (property == r->document->face_corners)
            status = read_corners(r, face);
        else
            ffd_ply_walk_skip(&r->walk, property);
    }
    return status;
}

/* Reads the rows of element face. A row that is not plain is read value by value, which reports what is wrong
   with it. */
static ffd_status read_rows(face_reader *r)
{
    const ply_document *const d = r->document;
    ply_plain_faces plain;
    const bool is_plain =
        ffd_ply_plain_faces(d->header.encoding, d->face, d->face_corners, d->file.part.vertex_count, &plain);
    ffd_status status = FFD_OK;
    ffd_ply_document_walk(d, d->face, &r->walk);
    for (uint64_t face = 0; status == FFD_OK && face < d->face->count; face++) {
        uint32_t corners[PLY_PLAIN_CORNERS];
        size_t count;
        if (!is_plain || !ffd_ply_plain_face(&plain, &r->walk, corners, &count))
            status = read_face(r, face);
        else if (!take_plain(r, corners, count))
            status = ffd_fail_memory(r->error);
    }
    return status;
}

/* Visits all faces, then the triangles of strips. The members of r say what to do with them. */
static ffd_status look_at_faces(face_reader *r)
{
    const ply_document *const d = r->document;
    const ffd_status status = d->face ? read_rows(r) : FFD_OK;
    return status ? status : ffd_ply_visit_strips(d, take_triangle, r, r->error);
}

static bool count_triangle(void *context, const uint32_t corners[3])
{
    size_t *const count = context;
    (void)corners;
    (*count)++;
    return true;
}

/* Allocates the arrays for the counted faces, and fills them. */
static ffd_status read_faces(const ply_document *d, mesh_faces *faces, ffd_error *error)
{
    face_reader r = {.document = d, .faces = faces, .capacity = faces->face_count, .error = error};
    ffd_status status = ffd_mesh_faces_make(&d->file.base, faces, faces->face_count, error);
    if (status)
        return status;
    ffd_file_document_read_positions(&d->file.base, 0, 0, faces->vertex_count, faces->positions);
    status = look_at_faces(&r);
    if (!status && r.face_count != faces->face_count)
        status = ffd_faces_changed(d->file.name, error);
    if (status)
        ffd_mesh_faces_free(faces);
    else
        faces->start[faces->face_count] = r.corners;
    return status;
}

ffd_status ffd_ply_check_faces(const ply_document *d, ffd_error *error)
{
    face_reader r = {.document = d, .error = error};
    return look_at_faces(&r);
}

ffd_status ffd_ply_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    const ply_element *edges = ffd_ply_find_edges(d);
    size_t triangles = 0;
    *faces =
        (mesh_faces){.vertex_count = d->file.part.vertex_count, .lines = edges ? (size_t)edges->count : 0};
    const ffd_status status = ffd_ply_visit_strips(d, count_triangle, &triangles, error);
    if (status)
        return status;
    faces->face_count = (d->face ? (size_t)d->face->count : 0) + triangles;
    return read_faces(d, faces, error);
}

ffd_status ffd_ply_mixed_faces(const mesh_document *document, const vertex_marks *marks, mesh_faces *faces,
                               ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    face_list list = {0};
    face_reader r = {.document = d, .mixed = &list, .marks = marks, .error = error};
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    ffd_status status = look_at_faces(&r);
    if (status == FFD_OK)
        status = ffd_face_lists_narrow(document, &list, 1, faces, error);
    if (status == FFD_OK)
        ffd_file_document_fill_positions(&d->file, faces);
    ffd_free(list.words);
    return status;
}

/* Marks the ends of the lines. Returns false if one is not the number of a vertex. */
static bool mark_edges(const ply_document *d, const ply_element *edges, uint8_t *used)
{
    const ply_property *const ends[2] = {ffd_ply_find_property(edges, "vertex1"),
                                         ffd_ply_find_property(edges, "vertex2")};
    ply_walk walk;
    text_word word;
    size_t vertex;
    bool valid = true;
    ffd_ply_document_walk(d, edges, &walk);
    for (uint64_t row = 0; row < edges->count && valid; row++) {
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < edges->property_count && valid; i++) {
            const ply_property *const property = &edges->properties[i];
            if (property->is_list || (property != ends[0] && property != ends[1])) {
                ffd_ply_walk_skip(&walk, property);
                continue;
            }
            ffd_ply_walk_value(&walk, property->type, &word);
            valid = ffd_ply_load_count(d->header.encoding, property->type, word, &vertex) &&
                    vertex < d->file.part.vertex_count;
            if (valid)
                used[vertex] = 1;
        }
    }
    return valid;
}

ffd_status ffd_ply_mark_used(mesh_document *document, ffd_error *error)
{
    ply_document *const d = (ply_document *)document;
    const size_t count = d->file.part.vertex_count;
    const ply_element *const edges = ffd_ply_find_edges(d);
    const ffd_status status = ffd_used_make(document, count, &d->file.used, error);
    if (status)
        return status;
    face_reader r = {.document = d, .used = d->file.used};
    const bool known = !look_at_faces(&r) && (!edges || mark_edges(d, edges, d->file.used));
    if (ffd_used_keep(document, count, &d->file.used) && known)
        d->file.part.used = d->file.used;
    return FFD_OK;
}
