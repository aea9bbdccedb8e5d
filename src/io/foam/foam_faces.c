/* foam_faces.c - the faces, and the cells on their two sides. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/foam/foam_mesh.h"
#include <inttypes.h>

/* "3(0 1 2)" */
#define LEAST_FACE 8

static ffd_status add_end(foam_reader *r, foam_file *f, size_t end)
{
    foam_faces *const faces = &r->faces;
    const size_t corners = end - (faces->count ? faces->ends[faces->count - 1] : 0);
    if (corners < 3)
        return FOAM_REFUSE(f, "face %zu (counted from 0) has %zu corners", faces->count, corners);
    if (!ffd_grow((void **)&faces->ends, &faces->capacity, faces->count + 1, sizeof *faces->ends))
        return ffd_fail_memory(r->error);
    faces->ends[faces->count++] = end;
    return FFD_OK;
}

/* A list of lists. */
static ffd_status take_lists(foam_reader *r, foam_file *f)
{
    foam_list list;
    uint64_t count;
    TRY(ffd_foam_list(f, "faces", LEAST_FACE, 0, &list, &count));
    for (uint64_t i = 0; i < count; i++) {
        TRY(ffd_foam_labels(f, "corners of a face", 0, &r->faces.corners));
        TRY(add_end(r, f, r->faces.corners.count));
    }
    return ffd_foam_list_end(f, "faces", list);
}

/* Where the corners of each face begin, and all corners. */
static ffd_status take_compact(foam_reader *r, foam_file *f)
{
    foam_labels starts = {0};
    ffd_status status;
    TRY_END(ffd_foam_labels(f, "places where faces begin", 0, &starts));
    TRY_END(ffd_foam_labels(f, "corners of faces", 0, &r->faces.corners));
    if (starts.count > 0 && starts.values[0] != 0)
        TRY_END(FOAM_REFUSE(f, "the first face begins at %" PRIu32 ", not at 0", starts.values[0]));
    for (size_t i = 1; i < starts.count; i++) {
        if (starts.values[i] < starts.values[i - 1])
            TRY_END(FOAM_REFUSE(f, "face %zu (counted from 0) ends before it begins", i - 1));
        TRY_END(add_end(r, f, starts.values[i]));
    }
    const size_t end = starts.count ? starts.values[starts.count - 1] : 0;
    if (end != r->faces.corners.count)
        TRY_END(FOAM_REFUSE(f, "the faces end at %zu of %zu corners", end, r->faces.corners.count));
end:
    ffd_free(starts.values);
    return status;
}

ffd_status ffd_foam_take_faces(foam_reader *r, foam_file *f)
{
    const foam_labels *const corners = &r->faces.corners;
    const size_t points = r->d->volume.file.part.vertex_count;
    TRY(ffd_foam_check_class(f, "faceList", "faceCompactList"));
    TRY(ffd_text_is(f->class, "faceList") ? take_lists(r, f) : take_compact(r, f));
    for (size_t face = 0, c = 0; face < r->faces.count; face++)
        for (; c < r->faces.ends[face]; c++)
            if (corners->values[c] >= points)
                return ffd_fail_file(r->error, FFD_E_INVALID, f->name,
                                     "face %zu (counted from 0) has the point %" PRIu32
                                     ", but there are only %zu",
                                     face, corners->values[c], points);
    if (r->faces.count >= UINT32_MAX)
        return ffd_fail_file(r->error, FFD_E_LIMIT, f->name, "has more than 2^32 - 2 faces");
    return FFD_OK;
}

/* Reads the number of faces between two cells in the note of a header. */
static bool read_note(text_word note, uint64_t *inner)
{
    static const char key[] = "nInternalFaces:";
    const char *const found = ffd_find_text(note.first, note.last, key);
    text_scan scan = {.at = found ? found + sizeof key - 1 : note.last, .last = note.last};
    text_word word;
    return ffd_text_word(&scan, &word) && ffd_text_whole(word, inner);
}

ffd_status ffd_foam_take_owner(foam_reader *r, foam_file *f)
{
    uint64_t inner;
    uint32_t largest = 0;
    TRY(ffd_foam_check_class(f, "labelList", NULL));
    TRY(ffd_foam_labels(f, "cells", r->faces.count, &r->owner));
    if (r->owner.count != r->faces.count)
        return ffd_fail_file(r->error, FFD_E_INVALID, f->name, "has %zu cells, but there are %zu faces",
                             r->owner.count, r->faces.count);
    for (size_t i = 0; i < r->owner.count; i++)
        largest = r->owner.values[i] > largest ? r->owner.values[i] : largest;
    /* A single cell has no face in common with another one. */
    if (largest == 0)
        r->faces.inner = 0;
    else if (read_note(f->note, &inner) && inner <= r->faces.count)
        r->faces.inner = (size_t)inner;
    return FFD_OK;
}

ffd_status ffd_foam_take_neighbour(foam_reader *r, foam_file *f)
{
    TRY(ffd_foam_check_class(f, "labelList", NULL));
    TRY(ffd_foam_labels(f, "cells", r->faces.count, &r->neighbour));
    if (r->neighbour.count > r->faces.count)
        return ffd_fail_file(r->error, FFD_E_INVALID, f->name, "has %zu cells, but there are %zu faces",
                             r->neighbour.count, r->faces.count);
    r->faces.inner = r->neighbour.count;
    return FFD_OK;
}
