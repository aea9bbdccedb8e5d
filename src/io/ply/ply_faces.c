/* ply_faces.c - checks the faces of a PLY file, and passes them on. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/ply/ply_document.h"
#include "io/ply/ply_walk.h"
#include "io/text/vectors.h"
#include "mesh/face_filler.h"
#include "mesh/mixed_faces.h"
#include <string.h>

/* Triangle strips: element tristrips, with a list of vertices. Each vertex makes a triangle with the two
   before it, with every second triangle reversed; -1 begins a new strip (as in the Stanford models).
   Degenerate triangles, which name a vertex twice, only join strips and are left out. */

/* Called for each triangle. Returns false if memory ran out. */
typedef bool ply_triangle_visitor(void *context, const uint32_t corners[3]);

typedef struct strip_reader {
    const ply_document *document;
    ply_walk walk;
    uint32_t last[2]; /* the two vertices before */
    size_t length;    /* number of vertices since the strip began */
    ply_triangle_visitor *visit;
    void *context;
    ffd_error *error;
} strip_reader;

/* Takes the next vertex of the strip. */
static ffd_status add_vertex(strip_reader *r, uint32_t vertex)
{
    const uint32_t a = r->last[0], b = r->last[1];
    const bool turned = r->length % 2 == 1; /* the second, the fourth, .. */
    const uint32_t triangle[3] = {turned ? b : a, turned ? a : b, vertex};
    const bool there = r->length >= 2 && a != b && a != vertex && b != vertex;
    r->last[0] = b;
    r->last[1] = vertex;
    r->length++;
    return !there || r->visit(r->context, triangle) ? FFD_OK : ffd_fail_memory(r->error);
}

static ffd_status read_strip(strip_reader *r, uint64_t row)
{
    const ply_document *d = r->document;
    const ply_property *const list = d->strip_corners;
    text_word word;
    size_t count, vertex;
    double value;
    r->length = 0;
    if (!ffd_ply_walk_list(&r->walk, list, &word, &count))
        return ffd_faces_changed(d->file.name, r->error);
    for (size_t i = 0; i < count; i++) {
        ffd_ply_walk_value(&r->walk, list->type, &word);
        if (ffd_ply_load_count(d->header.encoding, list->type, word, &vertex) &&
            vertex < d->file.part.vertex_count)
            TRY(add_vertex(r, (uint32_t)vertex));
        else if (ffd_ply_load(d->header.encoding, list->type, word, &value) && value == -1)
            r->length = 0;
        else
            TRY(ffd_ply_refuse_vertex(d, &r->walk, "strip", row, list->type, word, r->error));
    }
    return FFD_OK;
}

static ffd_status read_strip_row(strip_reader *r, uint64_t row)
{
    const ply_element *const strips = r->document->strips;
    ffd_ply_walk_row(&r->walk);
    for (size_t i = 0; i < strips->property_count; i++) {
        if (&strips->properties[i] == r->document->strip_corners)
            TRY(read_strip(r, row));
        else
            ffd_ply_walk_skip(&r->walk, &strips->properties[i]);
    }
    return FFD_OK;
}

/* Visits the triangles in the order of the file. Errors: FFD_E_INVALID for a vertex that does not exist,
   FFD_E_MEMORY. */
static ffd_status visit_strips(const ply_document *d, ply_triangle_visitor *visit, void *context,
                               ffd_error *error)
{
    strip_reader r = {.document = d, .visit = visit, .context = context, .error = error};
    if (!d->strip_corners)
        return FFD_OK;
    ffd_ply_document_walk(d, d->strips, &r.walk);
    for (uint64_t row = 0; row < d->strips->count; row++) {
        TRY(ffd_deadline_check_at((size_t)row, error));
        TRY(read_strip_row(&r, row));
    }
    return FFD_OK;
}

/* A fast path for the faces of nearly all binary files: rows with one list, whose count is a byte and whose
   corners are 32-bit, besides numbers of fixed size. It is many times faster than reading value by value. */

/* The maximum number of corners of a plain face. */
#define PLY_PLAIN_CORNERS 255

typedef struct ply_plain_faces {
    size_t before, behind; /* bytes of a row before the list, and after it */
    size_t limit;          /* corners must be less */
    unsigned count_limit;  /* counts must be less */
    bool swapped;          /* corners are big-endian */
} ply_plain_faces;

static uint32_t swap(uint32_t value)
{
    return value >> 24 | (value >> 8 & 0xff00) | (value << 8 & 0xff0000) | value << 24;
}

/* Reads a row and its corners. Returns false, and moves nothing, if the row is not as expected. Inline,
   because it is called for every face. */
static inline bool read_plain_face(const ply_plain_faces *plain, ply_walk *walk,
                                   uint32_t corners[PLY_PLAIN_CORNERS], size_t *count)
{
    const unsigned char *at = (const unsigned char *)walk->at + plain->before;
    const size_t left = (size_t)(walk->last - walk->at);
    uint32_t largest = 0;
    if (left <= plain->before || *at >= plain->count_limit ||
        left - plain->before - 1 < sizeof *corners * *at + plain->behind)
        return false;
    *count = *at++;
    for (size_t i = 0; i < *count; i++, at += sizeof *corners) {
        corners[i] = plain->swapped ? swap(load_u32(at)) : load_u32(at);
        largest = corners[i] > largest ? corners[i] : largest;
    }
    if (*count > 0 && largest >= plain->limit)
        return false;
    walk->at = (const char *)at + plain->behind;
    return true;
}

/* Whether the faces of an element are plain. vertices: the number of vertices. */
static bool find_plain_faces(ply_encoding encoding, const ply_element *element, const ply_property *list,
                             size_t vertices, ply_plain_faces *plain)
{
    const bool is_signed = list->type == NUMBER_INT32;
    const size_t largest = is_signed ? (size_t)INT32_MAX + 1 : UINT32_MAX;
    *plain = (ply_plain_faces){.limit = vertices < largest ? vertices : largest,
                               .count_limit = list->count_type == NUMBER_INT8 ? 128 : 256,
                               .swapped = encoding == PLY_BIG_ENDIAN};
    if (encoding == PLY_ASCII || ffd_type_size(list->count_type) != 1 ||
        (list->type != NUMBER_INT32 && list->type != NUMBER_UINT32))
        return false;
    for (size_t i = 0; i < element->property_count; i++) {
        const ply_property *const property = &element->properties[i];
        if (property != list && property->is_list)
            return false;
        if (property != list)
            *(property < list ? &plain->before : &plain->behind) += ffd_type_size(property->type);
    }
    return true;
}

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
    ffd_ply_walk_row(&r->walk);
    for (size_t i = 0; i < element->property_count; i++) {
        const ply_property *property = &element->properties[i];
        if (property == r->document->face_corners)
            TRY(read_corners(r, face));
        else
            ffd_ply_walk_skip(&r->walk, property);
    }
    return FFD_OK;
}

/* Reads the rows of element face. A row that is not plain is read value by value, which reports what is wrong
   with it. */
static ffd_status read_rows(face_reader *r)
{
    const ply_document *const d = r->document;
    ply_plain_faces plain;
    const bool is_plain =
        find_plain_faces(d->header.encoding, d->face, d->face_corners, d->file.part.vertex_count, &plain);
    ffd_ply_document_walk(d, d->face, &r->walk);
    for (uint64_t face = 0; face < d->face->count; face++) {
        uint32_t corners[PLY_PLAIN_CORNERS];
        size_t count;
        TRY(ffd_deadline_check_at((size_t)face, r->error));
        if (!is_plain || !read_plain_face(&plain, &r->walk, corners, &count))
            TRY(read_face(r, face));
        else if (!take_plain(r, corners, count))
            return ffd_fail_memory(r->error);
    }
    return FFD_OK;
}

/* Visits all faces, then the triangles of strips. The members of r say what to do with them. */
static ffd_status visit_faces(face_reader *r)
{
    const ply_document *const d = r->document;
    TRY(d->face ? read_rows(r) : FFD_OK);
    return visit_strips(d, take_triangle, r, r->error);
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
    TRY(ffd_mesh_faces_make(&d->file.base, faces, faces->face_count, error));
    ffd_vectors_read(d->file.positions, 0, faces->vertex_count, faces->positions);
    ffd_status status;
    TRY_END(visit_faces(&r));
    if (r.face_count != faces->face_count)
        TRY_END(ffd_faces_changed(d->file.name, error));
end:
    if (status)
        ffd_mesh_faces_free(faces);
    else
        faces->start[faces->face_count] = r.corners;
    return status;
}

ffd_status ffd_ply_check_faces(const ply_document *d, ffd_error *error)
{
    face_reader r = {.document = d, .error = error};
    return visit_faces(&r);
}

ffd_status ffd_ply_faces(const mesh_document *document, mesh_state state, mesh_faces *faces, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    const ply_element *edges = ffd_ply_find_edges(d);
    size_t triangles = 0;
    (void)state;
    *faces =
        (mesh_faces){.vertex_count = d->file.part.vertex_count, .lines = edges ? (size_t)edges->count : 0};
    TRY(visit_strips(d, count_triangle, &triangles, error));
    faces->face_count = (d->face ? (size_t)d->face->count : 0) + triangles;
    return read_faces(d, faces, error);
}

ffd_status ffd_ply_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                               mesh_faces *faces, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    face_list list = {0};
    face_reader r = {.document = d, .mixed = &list, .marks = marks, .error = error};
    (void)state;
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    ffd_status status;
    TRY_END(visit_faces(&r));
    TRY_END(ffd_face_lists_narrow(document, &list, 1, faces, error));
    ffd_file_document_fill_positions(&d->file, faces);
end:
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
    TRY(ffd_used_make(document, count, &d->file.used, error));
    face_reader r = {.document = d, .used = d->file.used};
    const bool known = !visit_faces(&r) && (!edges || mark_edges(d, edges, d->file.used));
    if (ffd_used_keep(document, count, &d->file.used) && known)
        d->file.part.used = d->file.used;
    return FFD_OK;
}
