/* ply_faces.c - checks and hands out the faces of a PLY file. */
#include "base/memory/memory.h"
#include "io/ply/ply_document.h"
#include <inttypes.h>
#include <string.h>

typedef struct face_reader {
    const ply_document *document;
    ply_walk walk;
    mesh_faces *faces; /* NULL: the corners are only looked at */
    size_t corners, capacity;
    ffd_error *error;
} face_reader;

static ffd_status refuse_index(const face_reader *r, uint64_t face, text_word word)
{
    const ply_document *d = r->document;
    const bool text = d->header.encoding == PLY_ASCII;
    double value = 0;
    ffd_ply_load(d->header.encoding, d->face_corners->type, word, &value);
    const number_text number = ffd_number_text(value);
    return ffd_fail_line(r->error, FFD_E_INVALID, d->file.name, text ? r->walk.line : 0,
                         "face %" PRIu64 " (counted from 0): %.*s is not an index of the %zu vertices", face,
                         text ? ffd_text_display_size(word) : (int)strlen(number.text),
                         text ? word.first : number.text, d->file.part.vertex_count);
}

static ffd_status read_corners(face_reader *r, uint64_t face)
{
    const ply_document *d = r->document;
    const ply_property *list = d->face_corners;
    text_word word;
    size_t count = 0;
    ffd_ply_walk_value(&r->walk, list->count_type, &word);
    ffd_ply_load_count(d->header.encoding, list->count_type, word, &count);
    if (r->faces &&
        !ffd_grow((void **)&r->faces->corners, &r->capacity, r->corners + count, sizeof *r->faces->corners))
        return ffd_fail_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        size_t vertex;
        ffd_ply_walk_value(&r->walk, list->type, &word);
        if (!ffd_ply_load_count(d->header.encoding, list->type, word, &vertex) ||
            vertex >= d->file.part.vertex_count)
            return refuse_index(r, face, word);
        if (r->faces)
            r->faces->corners[r->corners] = (uint32_t)vertex;
        r->corners++;
    }
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

static ffd_status read_faces(const ply_document *d, mesh_faces *faces, ffd_error *error)
{
    face_reader r = {.document = d, .faces = faces, .capacity = faces->face_count, .error = error};
    ffd_status status = FFD_OK;
    if (d->face)
        ffd_ply_document_walk(d, d->face, &r.walk);
    for (size_t face = 0; status == FFD_OK && face < faces->face_count; face++) {
        faces->start[face] = r.corners;
        status = read_face(&r, face);
    }
    faces->start[faces->face_count] = r.corners;
    return status;
}

ffd_status ffd_ply_check_faces(const ply_document *d, ffd_error *error)
{
    face_reader r = {.document = d, .error = error};
    ffd_status status = FFD_OK;
    if (!d->face)
        return FFD_OK;
    ffd_ply_document_walk(d, d->face, &r.walk);
    for (uint64_t face = 0; status == FFD_OK && face < d->face->count; face++)
        status = read_face(&r, face);
    return status;
}

static ffd_status refuse_strips(const ply_document *d, ffd_error *error)
{
    const ply_element *strips = ffd_ply_find_element(&d->header, "tristrips");
    if (!strips || strips->count == 0)
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_UNSUPPORTED, d->file.name, strips->line,
                         "element tristrips: triangle strips are not read as faces");
}

ffd_status ffd_ply_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    const ply_element *edges = ffd_ply_find_edges(d);
    *faces = (mesh_faces){.vertex_count = d->file.part.vertex_count,
                          .face_count = d->face ? (size_t)d->face->count : 0,
                          .lines = edges ? (size_t)edges->count : 0};
    ffd_status status = refuse_strips(d, error);
    if (status == FFD_OK)
        status = ffd_mesh_faces_make(document, faces, faces->face_count, error);
    if (status)
        return status;
    ffd_file_document_read_positions(document, 0, 0, faces->vertex_count, faces->positions);
    status = read_faces(d, faces, error);
    if (status)
        ffd_mesh_faces_free(faces);
    return status;
}
