/* vtkxml_save.c - writes a VTK file in XML with its results: the data of points and normals, the ranges that
   the points' tags state, and offsets of what is appended behind data of another length. */
#include "base/memory/memory.h"
#include "io/vtkxml/vtkxml_data.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* New bytes in place of some of the file's. */
typedef struct edit {
    const char *first, *last;
    byte_buffer bytes;
} edit;

typedef struct edit_list {
    const vtkxml_document *d;
    edit *list;
    size_t count, capacity;
    ffd_error *error;
} edit_list;

/* Adds an edit without bytes; NULL: memory ran out. */
static edit *add_edit(edit_list *edits, const char *first, const char *last)
{
    if (!ffd_grow((void **)&edits->list, &edits->capacity, edits->count + 1, sizeof *edits->list)) {
        ffd_fail_memory(edits->error);
        return NULL;
    }
    edit *const added = &edits->list[edits->count++];
    *added = (edit){first, last, {0}};
    return added;
}

static ffd_status edit_text(edit_list *edits, const vtkxml_array *array, size_t tuples, const double *before,
                            const double *after)
{
    const vtkxml_data none = {0};
    const number_run run = ffd_vtkxml_run(edits->d, array, tuples, &none);
    file_splice splice;
    edit *const added = add_edit(edits, array->text.first, array->text.last);
    if (!added)
        return FFD_E_MEMORY;
    ffd_splice_begin_part(&splice, added->first, added->last, &added->bytes, edits->error);
    ffd_run_splice(&run, before, after, 3, &splice);
    return ffd_splice_end(&splice);
}

static ffd_status edit_data(edit_list *edits, const vtkxml_array *array, size_t tuples, const double *before,
                            const double *after)
{
    const size_t size = tuples * 3 * ffd_type_size(array->type);
    unsigned char *bytes = NULL;
    vtkxml_data data;
    edit *added = NULL;
    ffd_status status;
    TRY_END(ffd_vtkxml_decode(edits->d, array, size, &data, edits->error));
    bytes = ffd_alloc(size, 1);
    if (!bytes)
        TRY_END(ffd_fail_memory(edits->error));
    const number_run run = ffd_vtkxml_run(edits->d, array, tuples, &data);
    ffd_run_patch(&run, 0, tuples, before, after, 3, (char *)bytes);
    added = add_edit(edits, data.first, data.last);
    if (!added)
        TRY_END(FFD_E_MEMORY);
    TRY_END(ffd_vtkxml_encode(edits->d, &data, bytes, &added->bytes, edits->error));
end:
    ffd_free(bytes);
    ffd_vtkxml_data_free(&data);
    return status;
}

/* Replaces the vectors of a piece, if any has changed. *changed: whether it has. */
static ffd_status edit_vectors(edit_list *edits, const vtkxml_piece *piece, const vtkxml_array *array,
                               const double *before, const double *after, bool *changed)
{
    const size_t at = 3 * piece->vertex, count = (size_t)piece->points;
    *changed = memcmp(before + at, after + at, 3 * count * sizeof *after) != 0;
    if (!*changed)
        return FFD_OK;
    return array->place == VTKXML_TEXT ? edit_text(edits, array, count, before + at, after + at)
                                       : edit_data(edits, array, count, before + at, after + at);
}

static ffd_status edit_number(edit_list *edits, text_word text, double value)
{
    if (text.first == text.last)
        return FFD_OK;
    edit *const added = add_edit(edits, text.first, text.last);
    if (!added)
        return FFD_E_MEMORY;
    ffd_buffer_number(&added->bytes, value);
    return added->bytes.failed ? ffd_fail_memory(edits->error) : FFD_OK;
}

/* VTK states the least and the largest distance of a point from the origin. */
static ffd_status edit_range(edit_list *edits, const vtkxml_piece *piece, const double *points)
{
    double least = INFINITY, most = -INFINITY;
    for (size_t v = piece->vertex; v < piece->vertex + piece->points; v++) {
        const double *const p = points + 3 * v;
        const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        least = length < least ? length : least;
        most = length > most ? length : most;
    }
    if (!isfinite(least) || !isfinite(most))
        return FFD_OK;
    TRY(edit_number(edits, piece->points_array.range_min, least));
    return edit_number(edits, piece->points_array.range_max, most);
}

/* How far what was at a place of the appended data has moved. */
static int64_t shift_of(const edit_list *edits, size_t count, const char *place)
{
    int64_t shift = 0;
    for (size_t i = 0; i < count; i++) {
        const edit *const e = &edits->list[i];
        if (e->first >= edits->d->appended.first && e->first < place)
            shift += (int64_t)e->bytes.size - (e->last - e->first);
    }
    return shift;
}

static ffd_status edit_offsets(edit_list *edits)
{
    const vtkxml_document *const d = edits->d;
    const size_t count = edits->count;
    for (size_t i = 0; i < d->placed_count && d->appended.first; i++) {
        const vtkxml_array *const array = &d->placed[i];
        if (array->offset > (uint64_t)(d->appended.last - d->appended.first))
            continue;
        const int64_t shift = shift_of(edits, count, d->appended.first + array->offset);
        if (shift == 0 || array->offset_text.first == array->offset_text.last)
            continue;
        edit *const added = add_edit(edits, array->offset_text.first, array->offset_text.last);
        if (!added)
            return FFD_E_MEMORY;
        ffd_buffer_format(&added->bytes, "%" PRId64, (int64_t)array->offset + shift);
        if (added->bytes.failed)
            return ffd_fail_memory(edits->error);
    }
    return FFD_OK;
}

/* Whether several arrays have the data that an edit replaces. */
static bool is_shared(const edit_list *edits, const edit *e)
{
    const vtkxml_document *const d = edits->d;
    size_t arrays = 0;
    for (size_t i = 0; i < d->placed_count && d->appended.first && e->first >= d->appended.first; i++) {
        const uint64_t offset = d->placed[i].offset;
        arrays += offset >= (uint64_t)(e->first - d->appended.first) &&
                  offset < (uint64_t)(e->last - d->appended.first);
    }
    return arrays > 1;
}

static int compare_edits(const void *a, const void *b)
{
    const edit *const x = a, *const y = b;
    return x->first < y->first ? -1 : x->first > y->first;
}

static ffd_status make_edits(edit_list *edits)
{
    const vtkxml_document *const d = edits->d;
    const file_document *const file = &d->volume.file;
    bool changed;
    for (size_t p = 0; p < d->piece_count; p++) {
        const vtkxml_piece *const piece = &d->pieces[p];
        if (piece->points == 0)
            continue;
        TRY(edit_vectors(edits, piece, &piece->points_array, file->positions, file->new_positions, &changed));
        if (changed)
            TRY(edit_range(edits, piece, file->new_positions));
        if (file->new_directions)
            TRY(edit_vectors(edits, piece, &piece->normals, file->directions, file->new_directions,
                             &changed));
    }
    TRY(edit_offsets(edits));
    if (edits->count > 1)
        qsort(edits->list, edits->count, sizeof *edits->list, compare_edits);
    for (size_t i = 0; i < edits->count; i++)
        if (is_shared(edits, &edits->list[i]) || (i > 0 && edits->list[i].first < edits->list[i - 1].last))
            return ffd_fail_file(edits->error, FFD_E_UNSUPPORTED, file->name,
                                 "several arrays share data that would change");
    return FFD_OK;
}

static void free_edits(edit_list *edits)
{
    for (size_t i = 0; i < edits->count; i++)
        ffd_buffer_free(&edits->list[i].bytes);
    ffd_free(edits->list);
}

ffd_status ffd_vtkxml_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                           const mesh_log *log, ffd_error *error)
{
    const vtkxml_document *const d = ffd_vtkxml_of(document);
    edit_list edits = {.d = d, .error = error};
    file_splice splice;
    ffd_status status = FFD_OK;
    if (!output)
        return FFD_OK;
    if (d->volume.file.new_positions)
        TRY_END(make_edits(&edits));
    ffd_splice_begin(&splice, &d->volume.file, options, output, error);
    for (size_t i = 0; i < edits.count; i++) {
        const edit *const e = &edits.list[i];
        ffd_splice_part(&splice, e->first, e->last, &e->bytes);
    }
    if (d->volume.file.new_positions)
        ffd_volume_warn_kept(&d->volume, log);
    status = ffd_splice_end(&splice);
end:
    free_edits(&edits);
    return status;
}
