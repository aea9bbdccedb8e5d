/* ply_results.c - stores the results of a PLY file. */
#include "io/ply/ply_document.h"

ffd_status ffd_ply_begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    ply_document *const d = (ply_document *)document;
    d->renew_normals = results->directions;
    if (results->directions && d->has_whole_normals)
        return ffd_fail_line(error, FFD_E_UNSUPPORTED, d->file.name, d->vertex->line,
                             "nx ny nz are not all float or double: such normals can only be kept");
    TRY(ffd_ply_begin_splats(d, results, error));
    return ffd_file_document_begin_results(document, results, error);
}

/* Rounds to the types of the file. */
void ffd_ply_write(mesh_document *document, size_t part, mesh_stream stream, size_t first, size_t count,
                   const double *xyz, const uint8_t *changed)
{
    const ply_document *d = ffd_ply_of(document);
    double *const results = stream == MESH_POSITIONS ? d->file.new_positions : d->file.new_directions;
    const number_type *const types = d->types + (stream == MESH_POSITIONS ? 0 : PLY_NORMAL_SLOT);
    (void)part;
    for (size_t i = 0; results && i < count; i++)
        for (size_t a = 0; a < 3 && changed[i]; a++)
            results[3 * (first + i) + a] = number_round(types[a], xyz[3 * i + a]);
}
