/* off_faces.c - reads the faces of an OFF file, and passes them on. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "io/off/off_document.h"
#include "io/text/vectors.h"
#include "mesh/face_filler.h"
#include "mesh/mixed_faces.h"
#include <inttypes.h>

static ffd_status refuse_corner(const off_document *d, const text_scan *scan, text_word word,
                                ffd_error *error)
{
    uint64_t index;
    const text_shown shown = ffd_text_shown(word);
    if (!ffd_text_whole(word, &index))
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->line,
                             "a corner is not a whole number: \"%s\"", shown.text);
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->line, "there is no vertex %s%s",
                         shown.text, ffd_only(d->header.vertices, " (counted from 0)").text);
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

static ffd_status read_face(off_document *d, off_walk *walk, ffd_error *error)
{
    uint64_t corners, index;
    text_word count, word;
    if (!ffd_off_walk_whole(walk, &count, &corners))
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                             "a face's number of corners is not a whole number: \"%.*s\"",
                             ffd_text_display_size(count), count.first);
    for (uint64_t i = 0; i < corners; i++) {
        const bool whole = ffd_off_walk_whole(walk, &word, &index);
        if (!whole && word.first == word.last)
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                                 "a face states %.*s %s, found %" PRIu64, ffd_text_display_size(count),
                                 count.first, ffd_plural(corners, "corner", "corners"), i);
        if (!whole || index >= d->header.vertices)
            return refuse_corner(d, &walk->scan, word, error);
        d->file.used[index] = 1;
    }
    count_face(d, (size_t)corners);
    return FFD_OK;
}

ffd_status ffd_off_read_faces(off_document *d, off_walk *walk, ffd_error *error)
{
    /* Fits into memory: a vertex takes more bytes of the file. */
    d->file.used = ffd_alloc_zero(d->header.vertices, 1);
    if (!d->file.used)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->header.faces; i++) {
        TRY(ffd_deadline_check_at(i, error));
        if (!ffd_off_walk_face(walk))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, walk->scan.line,
                                 "the file ends after %zu of %zu faces", i, d->header.faces);
        TRY(read_face(d, walk, error));
    }
    return FFD_OK;
}

static ffd_status fill_faces(const off_document *d, mesh_faces *faces, ffd_error *error)
{
    off_walk walk = d->faces_begin;
    face_filler filler = {.faces = faces, .corners = d->corners};
    for (size_t i = 0; i < d->header.faces && !filler.ends; i++) {
        const size_t corners = ffd_off_walk_face_size(&walk);
        const bool polygon = corners != 1 && corners != 2;
        if (polygon)
            ffd_filler_face(&filler);
        for (size_t c = 0; c < corners && !filler.ends; c++) {
            const uint32_t index = ffd_off_walk_corner_index(&walk);
            if (polygon)
                ffd_filler_corner(&filler, index);
        }
    }
    return ffd_filler_end(&filler, d->file.name, error);
}

ffd_status ffd_off_faces(const mesh_document *document, mesh_state state, mesh_faces *faces, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    (void)state;
    *faces = (mesh_faces){.vertex_count = d->header.vertices,
                          .face_count = d->header.faces - d->lines - d->points,
                          .lines = d->lines,
                          .points = d->points};
    TRY(ffd_mesh_faces_make(document, faces, d->corners, error));
    ffd_vectors_read(d->file.positions, 0, faces->vertex_count, faces->positions);
    return fill_faces(d, faces, error);
}

ffd_status ffd_off_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                               mesh_faces *faces, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    off_walk walk = d->faces_begin;
    face_list list = {0};
    bool has_changed = false;
    (void)state;
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    for (size_t i = 0; i < d->header.faces && !has_changed; i++) {
        for (size_t left = ffd_off_walk_face_size(&walk); left > 0 && !has_changed; left--) {
            const uint32_t vertex = ffd_off_walk_corner_index(&walk);
            /* It was checked when the file was opened: the file has changed since. */
            has_changed = vertex >= d->header.vertices;
            if (!has_changed)
                ffd_face_list_corner(&list, vertex);
        }
        if (list.pending == 1 || list.pending == 2) /* a point or a line */
            list.pending = 0;
        ffd_face_list_end(&list, marks);
    }
    ffd_status status;
    TRY_END(has_changed ? ffd_faces_changed(d->file.name, error)
                        : ffd_face_lists_narrow(document, &list, 1, faces, error));
    ffd_file_document_fill_positions(&d->file, faces);
end:
    ffd_free(list.words);
    return status;
}

ffd_status ffd_off_mark_used(mesh_document *document, ffd_error *error)
{
    off_document *const d = (off_document *)document;
    /* The array exists since the file was read; only now is it counted. */
    TRY(ffd_budget_take(&document->budget, d->header.vertices, 1, error));
    if (ffd_used_keep(document, d->header.vertices, &d->file.used))
        d->file.part.used = d->file.used;
    return FFD_OK;
}
