#include "io/vtk/vtk_format.h"
#include "io/vtk/vtk_reader.h"
#include <inttypes.h>
#include <stdio.h>

static ffd_status take_version(vtk_reader *r)
{
    text_word word;
    double version = 0;
    if (!ffd_text_word(&r->scan, &word) || !ffd_text_is(word, "#") || !ffd_text_word(&r->scan, &word) ||
        !ffd_text_is(word, "vtk"))
        return ffd_fail_file(r->error, FFD_E_INVALID, r->d->file.name,
                             "does not begin with \"# vtk DataFile Version\"");
    while (ffd_text_word(&r->scan, &word))
        ffd_text_number(word, &version);
    r->has_offsets = version >= 5;
    ffd_text_next_line(&r->scan);
    ffd_text_next_line(&r->scan); /* the title */
    return FFD_OK;
}

static ffd_status take_dataset(vtk_reader *r)
{
    static const char *const names[] = {
        [VTK_POLYDATA] = "POLYDATA",
        [VTK_UNSTRUCTURED] = "UNSTRUCTURED_GRID",
        [VTK_STRUCTURED] = "STRUCTURED_GRID",
    };
    text_word word;
    TRY(ffd_vtk_word(r, "DATASET", &word));
    if (!ffd_text_is(word, "DATASET"))
        return VTK_REFUSE(r, "\"%s\" is not DATASET", ffd_text_shown(word).text);
    TRY(ffd_vtk_word(r, "a kind of data", &word));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (ffd_text_is(word, names[i])) {
            r->dataset = (vtk_dataset)i;
            r->d->content = names[i];
            return FFD_OK;
        }
    return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, vtk_line(r),
                         "the data are a %s: only POLYDATA, UNSTRUCTURED_GRID and STRUCTURED_GRID have "
                         "points that can move",
                         ffd_text_shown(word).text);
}

static ffd_status take_front(vtk_reader *r)
{
    text_word word;
    TRY(take_version(r));
    TRY(ffd_vtk_word(r, "ASCII or BINARY", &word));
    const bool is_binary = ffd_text_is_any_case(word, "binary");
    if (!is_binary && !ffd_text_is_any_case(word, "ascii"))
        return VTK_REFUSE(r, "\"%s\" is not ASCII or BINARY", ffd_text_shown(word).text);
    TRY(take_dataset(r));
    r->is_binary = is_binary;
    r->d->encoding = is_binary ? "binary big endian" : "ascii";
    return FFD_OK;
}

static ffd_status take_dimensions(vtk_reader *r)
{
    for (int a = 0; a < 3; a++)
        TRY(ffd_vtk_count(r, "a dimension", &r->dimensions[a]));
    r->has_dimensions = true;
    return FFD_OK;
}

/* POINT_DATA or CELL_DATA, and the number of tuples. */
static ffd_status take_owner(vtk_reader *r, vtk_owner owner)
{
    const size_t points = r->d->file.part.vertex_count;
    r->owner = owner;
    TRY(ffd_vtk_count(r, "a number of tuples", &r->tuples));
    return owner == VTK_OF_CELLS || r->tuples == points
               ? FFD_OK
               : VTK_REFUSE(r, "POINT_DATA are of %" PRIu64 " points, but there are %zu", r->tuples, points);
}

static ffd_status take_part(vtk_reader *r, text_word word)
{
    bool taken;
    if (ffd_text_is(word, "DIMENSIONS") && r->dataset == VTK_STRUCTURED)
        return take_dimensions(r);
    if (ffd_text_is(word, "POINTS"))
        return ffd_vtk_points(r);
    if (ffd_text_is(word, "POINT_DATA"))
        return take_owner(r, VTK_OF_POINTS);
    if (ffd_text_is(word, "CELL_DATA"))
        return take_owner(r, VTK_OF_CELLS);
    TRY(ffd_vtk_cells(r, word, &taken));
    return taken ? FFD_OK : ffd_vtk_attribute(r, word);
}

static ffd_status take_parts(vtk_reader *r)
{
    text_word word;
    while (ffd_text_find(&r->scan) && ffd_text_word(&r->scan, &word)) {
        if (ffd_text_is(word, "METADATA"))
            ffd_vtk_metadata(r);
        else
            TRY(take_part(r, word));
    }
    if (!r->has_points)
        return ffd_fail_file(r->error, FFD_E_INVALID, r->d->file.name, "has no POINTS");
    return ffd_vtk_end_cells(r);
}

static ffd_status open_vtk(file_input *input, const ffd_source *source, mesh_document **document,
                           ffd_error *error)
{
    vtk_reader r = {.d = ffd_volume_make(sizeof(volume_document), input, source, error), .error = error};
    if (!r.d)
        return FFD_E_MEMORY;
    ffd_text_begin(&r.scan, input->data, input->size, false);
    ffd_status status;
    TRY_END(take_front(&r));
    TRY_END(take_parts(&r));
    *document = ffd_volume_ready(r.d, !r.is_binary, source);
    return FFD_OK;
end:
    ffd_volume_free(r.d);
    return status;
}

const mesh_format ffd_vtk_format = {
    .format = FFD_FORMAT_VTK,
    .name = "VTK",
    .open = open_vtk,
    .close = ffd_volume_close,
    .save = ffd_volume_save,
    .weights = &ffd_volume_weights,
    VOLUME_CALLS,
};
