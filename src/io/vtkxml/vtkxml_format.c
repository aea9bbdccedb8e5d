#include "io/vtkxml/vtkxml_format.h"
#include "base/memory/memory.h"
#include "io/vtkxml/vtkxml_data.h"
#include <inttypes.h>

/* A file is at least the thousandth part of what it holds: more cannot be compressed. */
#define LARGEST_GAIN UINT64_C(1040)

static ffd_status count_points(vtkxml_document *d, ffd_error *error)
{
    const uint64_t most = LARGEST_GAIN * d->volume.file.input.size;
    uint64_t count = 0;
    d->turns = true;
    for (size_t p = 0; p < d->piece_count; p++) {
        vtkxml_piece *const piece = &d->pieces[p];
        piece->vertex = (size_t)count;
        count += piece->points;
        d->turns = d->turns && piece->normals.is_there;
        if (count > most)
            return ffd_fail_line(error, FFD_E_INVALID, d->volume.file.name, piece->line,
                                 "a piece has %" PRIu64 " points, more than the file can hold",
                                 piece->points);
        if (piece->points && !piece->points_array.is_there)
            return ffd_fail_line(error, FFD_E_INVALID, d->volume.file.name, piece->line,
                                 "a piece has no array of its points");
    }
    /* Points and their results; each is in the file, too. */
    TRY(ffd_budget_check(&d->volume.file.base.budget, count, 3 * sizeof(double), error));
    return ffd_volume_make_points(&d->volume, count, 0, error);
}

/* first: the first piece with points. */
static ffd_status check_points(const vtkxml_document *d, const vtkxml_piece *first, const vtkxml_piece *piece,
                               ffd_error *error)
{
    const vtkxml_array *const array = &piece->points_array;
    const char *const name = d->volume.file.name;
    if (!array->is_number || !number_is_real(array->type))
        return ffd_fail_line(error, FFD_E_UNSUPPORTED, name, array->line,
                             "the points are not Float32 or Float64: only these can be deformed");
    if (array->width != 3)
        return ffd_fail_line(error, FFD_E_INVALID, name, array->line, "the points have %zu components, not 3",
                             array->width);
    if (array->type != first->points_array.type)
        return ffd_fail_line(error, FFD_E_UNSUPPORTED, name, array->line,
                             "the pieces have points of different types");
    return FFD_OK;
}

/* Reads points or normals of a piece, and notes which bytes they are. */
static ffd_status read_vectors(vtkxml_document *d, const vtkxml_piece *piece, const vtkxml_array *array,
                               const char *what, double *vectors, ffd_error *error)
{
    const char *first, *last;
    TRY(ffd_vtkxml_read(d, array, piece->points, what, vectors + 3 * piece->vertex, &first, &last, error));
    TRY(ffd_volume_add_span(&d->volume, first, last, error));
    if (array->range_min.first < array->range_min.last)
        TRY(ffd_volume_add_span(&d->volume, array->range_min.first, array->range_min.last, error));
    return array->range_max.first < array->range_max.last
               ? ffd_volume_add_span(&d->volume, array->range_max.first, array->range_max.last, error)
               : FFD_OK;
}

static ffd_status read_points(vtkxml_document *d, ffd_error *error)
{
    volume_document *const v = &d->volume;
    const vtkxml_piece *first = NULL;
    TRY(count_points(d, error));
    if (d->turns) {
        v->file.directions = ffd_alloc(v->file.part.vertex_count, 3 * sizeof *v->file.directions);
        if (!v->file.directions)
            return ffd_fail_memory(error);
    }
    for (size_t p = 0; p < d->piece_count; p++) {
        const vtkxml_piece *const piece = &d->pieces[p];
        if (piece->points == 0)
            continue;
        first = first ? first : piece;
        TRY(check_points(d, first, piece, error));
        TRY(read_vectors(d, piece, &piece->points_array, "point", v->file.positions, error));
        v->point_type = piece->points_array.type;
        if (!d->turns)
            continue;
        TRY(read_vectors(d, piece, &piece->normals, "normal", v->file.directions, error));
        v->normal_type = piece->normals.type;
    }
    return FFD_OK;
}

/* Where compressed data have another length, offsets behind them change. */
static ffd_status note_offsets(vtkxml_document *d, ffd_error *error)
{
    for (size_t i = 0; i < d->placed_count && d->is_compressed; i++) {
        const text_word text = d->placed[i].offset_text;
        if (text.first < text.last)
            TRY(ffd_volume_add_span(&d->volume, text.first, text.last, error));
    }
    return FFD_OK;
}

static void free_lists(vtkxml_document *d)
{
    ffd_free(d->pieces);
    ffd_free(d->values);
    ffd_free(d->placed);
}

static ffd_status open_grid(file_input *input, const ffd_source *source, vtkxml_grid grid,
                            mesh_document **document, ffd_error *error)
{
    vtkxml_document *const d = (vtkxml_document *)ffd_volume_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    d->grid = grid;
    ffd_status status;
    TRY_END(ffd_vtkxml_tags(d, error));
    TRY_END(read_points(d, error));
    TRY_END(ffd_vtkxml_cells(d, error));
    TRY_END(note_offsets(d, error));
    *document = ffd_volume_ready(&d->volume, true, source);
    return FFD_OK;
end:
    free_lists(d);
    ffd_volume_free(&d->volume);
    return status;
}

static ffd_status open_vtu(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    return open_grid(input, source, VTKXML_UNSTRUCTURED, document, error);
}

static ffd_status open_vtp(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    return open_grid(input, source, VTKXML_POLYDATA, document, error);
}

static ffd_status open_vts(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    return open_grid(input, source, VTKXML_STRUCTURED, document, error);
}

static void close_grid(mesh_document *document)
{
    if (document)
        free_lists((vtkxml_document *)document);
    ffd_volume_close(document);
}

#define CALLS                                                                                                \
    VOLUME_CALLS, .is_xml = true, .close = close_grid, .save = ffd_vtkxml_save, .weights = &ffd_vtkxml_weights

const mesh_format ffd_vtu_format = {.format = FFD_FORMAT_VTU, .name = "VTU", .open = open_vtu, CALLS};
const mesh_format ffd_vtp_format = {.format = FFD_FORMAT_VTP, .name = "VTP", .open = open_vtp, CALLS};
const mesh_format ffd_vts_format = {.format = FFD_FORMAT_VTS, .name = "VTS", .open = open_vts, CALLS};
