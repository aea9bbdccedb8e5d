/* off_faces.c - reads and hands out the faces of an OFF file. */
#include "io/off/off_document.h"
#include <inttypes.h>

static ffd_status check_corner(const off_document *d, const text_scan *scan, text_word word, ffd_error *error)
{
    uint64_t index;
    const int shown = ffd_text_display_size(word);
    if (!ffd_text_whole(word, &index))
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->line,
                             "a corner is not a whole number: \"%.*s\"", shown, word.first);
    if (index >= d->header.vertices)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->line,
                             "vertex %.*s is out of range: there are %zu, counted from 0", shown, word.first,
                             d->header.vertices);
    return FFD_OK;
}

static void count_face(off_document *d, size_t corners)
{
    if (corners == 1)
        d->points++;
    else if (corners == 2)
        d->lines++;
    else
        d->corners += corners;
}

static ffd_status read_face(off_document *d, off_walk *walk, text_word count, ffd_error *error)
{
    uint64_t corners;
    text_word word;
    if (!ffd_text_whole(count, &corners))
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                             "a face's number of corners is not a whole number: \"%.*s\"",
                             ffd_text_display_size(count), count.first);
    for (uint64_t i = 0; i < corners; i++) {
        if (!ffd_off_walk_corner(walk, &word))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                                 "a face states %.*s corners, found %" PRIu64, ffd_text_display_size(count),
                                 count.first, i);
        const ffd_status status = check_corner(d, &walk->scan, word, error);
        if (status)
            return status;
    }
    count_face(d, (size_t)corners);
    return FFD_OK;
}

ffd_status ffd_off_read_faces(off_document *d, off_walk *walk, ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (size_t i = 0; status == FFD_OK && i < d->header.faces; i++) {
        text_word count;
        if (!ffd_off_walk_face(walk, &count))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                                 "the file ends after %zu of %zu faces", i, d->header.faces);
        status = read_face(d, walk, count, error);
    }
    return status;
}

static void fill_faces(const off_document *d, mesh_faces *faces)
{
    off_walk walk;
    off_vertex vertex;
    size_t face = 0, count = 0;
    ffd_off_walk_begin(&d->header, &walk);
    for (size_t i = 0; i < d->header.vertices; i++)
        ffd_off_walk_vertex(&walk, &vertex);
    for (size_t i = 0; i < d->header.faces; i++) {
        const size_t corners = ffd_off_walk_face_size(&walk);
        const bool polygon = corners != 1 && corners != 2;
        if (polygon)
            faces->start[face++] = count;
        for (size_t c = 0; c < corners; c++) {
            const uint32_t index = ffd_off_walk_corner_index(&walk);
            if (polygon)
                faces->corners[count++] = index;
        }
    }
    faces->start[face] = count;
}

ffd_status ffd_off_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    *faces = (mesh_faces){.vertex_count = d->header.vertices,
                          .face_count = d->header.faces - d->lines - d->points,
                          .lines = d->lines,
                          .points = d->points};
    const ffd_status status = ffd_mesh_faces_make(document, faces, d->corners, error);
    if (status)
        return status;
    ffd_file_document_read_positions(document, 0, 0, faces->vertex_count, faces->positions);
    fill_faces(d, faces);
    return FFD_OK;
}
