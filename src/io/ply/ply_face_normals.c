/* ply_face_normals.c - computes the normals nx ny nz of faces anew where a corner has moved: from the corners
   as written, on the same side of the face as before. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/ply/ply_save.h"
#include "mesh/polygon.h"
#include <string.h>

/* A walk over the rows of the faces. */
typedef struct face_writer {
    const ply_document *document;
    file_splice *splice;
    uint32_t *corners; /* of the current face */
    size_t count, capacity;
    /* The words of nx ny nz in the order of the row, and the axis of each. */
    text_word words[3];
    size_t axes[3], found;
} face_writer;

/* Reads the corners of a face. count is 0 if any of them is not the number of a vertex. */
static void take_corners(face_writer *w, ply_walk walk)
{
    const ply_document *d = w->document;
    text_word word;
    size_t count, vertex;
    w->count = 0;
    ffd_ply_walk_list(&walk, d->face_corners, &word, &count);
    if (!ffd_grow((void **)&w->corners, &w->capacity, count, sizeof *w->corners)) {
        w->splice->status = ffd_fail_memory(w->splice->error);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (!ffd_ply_walk_count(&walk, d->face_corners->type, &word, &vertex) ||
            vertex >= d->file.part.vertex_count)
            return;
        w->corners[i] = (uint32_t)vertex;
    }
    w->count = count;
}

static void take_row(face_writer *w, ply_walk *walk)
{
    const ply_document *d = w->document;
    w->count = w->found = 0;
    ffd_ply_walk_row(walk);
    for (size_t i = 0; i < d->face->property_count; i++) {
        const ply_property *const property = &d->face->properties[i];
        size_t axis = 0;
        while (axis < 3 && property != d->face_normals[axis])
            axis++;
        if (axis < 3) {
            w->axes[w->found] = axis;
            ffd_ply_walk_value(walk, property->type, &w->words[w->found++]);
            continue;
        }
        if (property == d->face_corners)
            take_corners(w, *walk);
        ffd_ply_walk_skip(walk, property);
    }
}

static bool has_moved(const face_writer *w)
{
    const file_document *const file = &w->document->file;
    for (size_t i = 0; i < w->count; i++) {
        const size_t at = 3 * (size_t)w->corners[i];
        if (memcmp(file->positions + at, file->new_positions + at, 3 * sizeof *file->positions) != 0)
            return true;
    }
    return false;
}

/* Computes the unit normal of a moved face. It points to the side of the old normal, even if the order of the
   corners says otherwise. Returns false if the old normal stays: the corners have no normal, or the old one
   is zero, which programs write for none. */
static bool renew(const face_writer *w, const double old[3], double normal[3])
{
    const file_document *const file = &w->document->file;
    double rest[3];
    if ((old[0] == 0 && old[1] == 0 && old[2] == 0) ||
        !ffd_polygon_normal(file->new_positions, w->corners, w->count, normal, NULL))
        return false;
    const bool is_other_side =
        ffd_polygon_normal(file->positions, w->corners, w->count, rest, NULL) && vec_dot(rest, old) < 0;
    const double length = is_other_side ? -vec_length(normal) : vec_length(normal);
    for (int a = 0; a < 3; a++)
        normal[a] = normal[a] / length + 0.0; /* + 0.0: 0 without a sign */
    return true;
}

static void write_normal(face_writer *w)
{
    const ply_document *d = w->document;
    const ply_encoding encoding = d->header.encoding;
    double old[3], normal[3];
    for (size_t i = 0; i < 3; i++)
        if (!ffd_ply_load(encoding, d->face_normals[w->axes[i]]->type, w->words[i], &old[w->axes[i]]))
            return;
    if (!renew(w, old, normal))
        return;
    for (size_t i = 0; i < 3; i++) {
        const number_type type = d->face_normals[w->axes[i]]->type;
        const double value = number_round(type, normal[w->axes[i]]);
        char bytes[FFD_NUMBER_CAPACITY];
        if (value != old[w->axes[i]])
            ffd_splice_replace(w->splice, w->words[i], bytes, ffd_ply_store(encoding, type, value, bytes));
    }
}

void ffd_ply_write_face_normals(const ply_document *d, file_splice *splice)
{
    face_writer w = {.document = d, .splice = splice};
    ply_walk walk;
    ffd_ply_document_walk(d, d->face, &walk);
    for (uint64_t row = 0; splice->status == FFD_OK && row < d->face->count; row++) {
        take_row(&w, &walk);
        if (splice->status == FFD_OK && has_moved(&w))
            write_normal(&w);
    }
    ffd_free(w.corners);
}
