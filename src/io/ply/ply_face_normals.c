/* ply_face_normals.c - renews the normals that faces have, nx ny nz, where a corner has moved: they are those
   of the corners as they are written, on the side on which they were. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/ply/ply_save.h"
#include "mesh/polygon.h"
#include <string.h>

/* The rows of the faces, one after the other. */
typedef struct face_writer {
    const ply_document *document;
    file_splice *splice;
    uint32_t *corners; /* of the face */
    size_t count, capacity;
    /* What stands for nx ny nz, in the order of the row, and which it is. */
    text_word words[3];
    size_t axes[3], found;
} face_writer;

/* Takes the corners. Those of a face that names a vertex that does not exist are not known: count is 0. */
static void take_corners(face_writer *w, ply_walk walk)
{
    const ply_document *d = w->document;
    text_word word;
    size_t count = 0, vertex;
    w->count = 0;
    ffd_ply_walk_count(&walk, d->face_corners->count_type, &word, &count);
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

/* The normal of the moved face, of length 1. Where the order of its corners says otherwise than the file's
   normal, the side of that is kept. Returns false if the normal is kept as it is: the corners give none, or
   it is zero, by which programs mean that there is none. */
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
        normal[a] = normal[a] / length + 0.0; /* 0 has no sign */
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
        const ply_type type = d->face_normals[w->axes[i]]->type;
        const double value = ply_round(type, normal[w->axes[i]]);
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
