#include "io/vtk/vtk_reader.h"
#include <inttypes.h>
#include <string.h>

static const vtk_type types[] = {{"unsigned_char", NUMBER_UINT8, VTK_NUMBERS},
                                 {"char", NUMBER_INT8, VTK_NUMBERS},
                                 {"unsigned_short", NUMBER_UINT16, VTK_NUMBERS},
                                 {"short", NUMBER_INT16, VTK_NUMBERS},
                                 {"unsigned_int", NUMBER_UINT32, VTK_NUMBERS},
                                 {"int", NUMBER_INT32, VTK_NUMBERS},
                                 {"unsigned_long", NUMBER_UINT64, VTK_NUMBERS},
                                 {"long", NUMBER_INT64, VTK_NUMBERS},
                                 {"float", NUMBER_FLOAT, VTK_NUMBERS},
                                 {"double", NUMBER_DOUBLE, VTK_NUMBERS},
                                 {"vtkidtype", NUMBER_INT32, VTK_NUMBERS},
                                 {"vtktypeint64", NUMBER_INT64, VTK_NUMBERS},
                                 {"vtktypeuint64", NUMBER_UINT64, VTK_NUMBERS},
                                 {"bit", NUMBER_UINT8, VTK_BITS},
                                 {"string", NUMBER_UINT8, VTK_TEXTS}};

ffd_status ffd_vtk_word(vtk_reader *r, const char *what, text_word *word)
{
    return ffd_text_find(&r->scan) && ffd_text_word(&r->scan, word)
               ? FFD_OK
               : VTK_REFUSE(r, "the file ends where %s is expected", what);
}

ffd_status ffd_vtk_count(vtk_reader *r, const char *what, uint64_t *count)
{
    text_word word;
    TRY(ffd_vtk_word(r, what, &word));
    if (!ffd_text_whole(word, count))
        return VTK_REFUSE(r, "\"%s\" is not %s", ffd_text_shown(word).text, what);
    return *count <= UINT64_C(8) * r->d->file.input.size && (size_t)*count == *count
               ? FFD_OK
               : VTK_REFUSE(r, "%s is %" PRIu64 ", more than the file can hold", what, *count);
}

ffd_status ffd_vtk_type(vtk_reader *r, const vtk_type **type)
{
    text_word word;
    TRY(ffd_vtk_word(r, "a type", &word));
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        if (ffd_text_is_any_case(word, types[t].name)) {
            *type = &types[t];
            return FFD_OK;
        }
    return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, vtk_line(r),
                         "arrays of the type \"%s\" are not supported", ffd_text_shown(word).text);
}

const char *ffd_vtk_binary(const vtk_reader *r)
{
    const char *const end = memchr(r->scan.at, '\n', (size_t)(r->scan.last - r->scan.at));
    return end ? end + 1 : r->scan.last;
}

void ffd_vtk_metadata(vtk_reader *r)
{
    text_word word;
    while (ffd_text_next_line(&r->scan) && ffd_text_word(&r->scan, &word))
        ;
}

ffd_status ffd_vtk_points(vtk_reader *r)
{
    const vtk_type *type;
    uint64_t count;
    const char *last;
    size_t line;
    if (r->has_points)
        return VTK_REFUSE(r, "there are POINTS twice");
    TRY(ffd_vtk_count(r, "the number of points", &count));
    TRY(ffd_vtk_type(r, &type));
    if (type->special || !number_is_real(type->type))
        return ffd_fail_line(r->error, FFD_E_UNSUPPORTED, r->d->file.name, vtk_line(r),
                             "the points are of the type %s: only float and double can be deformed",
                             type->name);
    r->has_points = true;
    number_run run = {.type = type->type,
                      .is_text = !r->is_binary,
                      .is_big = true,
                      .count = (size_t)count,
                      .width = 3,
                      .stride = 3 * ffd_type_size(type->type),
                      .first = r->is_binary ? ffd_vtk_binary(r) : r->scan.at,
                      .last = r->scan.last,
                      .line = vtk_line(r)};
    TRY(ffd_run_check(&run, r->d->file.name, "point", r->error));
    TRY(ffd_volume_make_points(r->d, count, vtk_line(r), r->error));
    TRY(ffd_volume_add_piece(r->d, MESH_POSITIONS, 0, &run, &last, &line, r->error));
    r->scan.at = last;
    r->scan.line = line;
    return FFD_OK;
}
