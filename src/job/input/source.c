#include "job/input/source.h"
#include "base/file/path.h"
#include "base/vector/vec.h"
#include "io/formats.h"
#include "mesh/bounds.h"
#include <string.h>

/* Positions read at once. */
#define BLOCK 256

const char *ffd_source_name(const ffd_source *source)
{
    return ffd_path_display_name(source->path);
}

ffd_status ffd_source_format(const ffd_source *source, ffd_format *format, ffd_error *error)
{
    *format = source->format != FFD_FORMAT_AUTO ? source->format : ffd_format_from_name(source->path);
    if (ffd_format_table(*format))
        return FFD_OK;
    if (strcmp(source->path, "-") == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "standard input needs --input-format " FORMAT_NAMES);
    return ffd_fail_file(error, FFD_E_ARGUMENT, source->path,
                         "the ending \"%s\" is not that of a mesh format (" FORMAT_NAMES ")",
                         ffd_path_ending(source->path));
}

ffd_status ffd_source_open(const ffd_source *source, int threads, mesh_document **document, ffd_error *error)
{
    file_input input;
    ffd_source typed = *source;
    *document = NULL;
    typed.threads = source->threads > 0 ? source->threads : threads;
    ffd_status status = ffd_source_format(source, &typed.format, error);
    if (status)
        return status;
    status = ffd_file_load(source->path, &input, error);
    if (status)
        return status;
    status = ffd_format_open(ffd_format_table(typed.format), &input, &typed, document, error);
    if (status) {
        ffd_file_unload(&input);
        ffd_fail_name_file(error, ffd_source_name(source));
    }
    return status;
}

ffd_status ffd_source_files(const ffd_source *source, const mesh_document *document, path_list *files,
                            ffd_error *error)
{
    ffd_status status = FFD_OK;
    if (!ffd_file_is_stream(source->path))
        status = ffd_paths_add(files, source->path, error);
    if (!status && document->format->list_files)
        status = document->format->list_files(document, files, error);
    return status;
}

void ffd_source_close(mesh_document **document)
{
    if (*document)
        (*document)->format->close(*document);
    *document = NULL;
}

void ffd_source_positions(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    document->format->read_positions(document, part, first, count, xyz);
    ffd_part_transform(document, part, first, count, xyz);
}

size_t ffd_source_widen(const mesh_document *document, size_t part, ffd_bounds *bounds)
{
    const size_t vertices = document->parts[part].vertex_count;
    size_t not_finite = 0;
    double xyz[3 * BLOCK];
    for (size_t first = 0; first < vertices; first += BLOCK) {
        const size_t left = vertices - first, count = left < BLOCK ? left : BLOCK;
        ffd_source_positions(document, part, first, count, xyz);
        for (size_t i = 0; i < count; i++)
            if (vec_is_finite(xyz + 3 * i))
                ffd_bounds_widen(bounds, xyz + 3 * i);
            else
                not_finite++;
    }
    return not_finite;
}
