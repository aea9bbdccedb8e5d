/* ply_results.c - stores the results of a PLY file. */
#include "io/ply/ply_document.h"

ffd_status ffd_ply_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    ply_document *const d = (ply_document *)document;
    d->renew_normals = normals;
    if (normals && d->has_whole_normals)
        return ffd_fail_line(error, FFD_E_UNSUPPORTED, d->file.name, d->vertex->line,
                             "nx ny nz are not all float or double: such normals can only be kept");
    TRY(ffd_ply_begin_splats(d, error));
    return ffd_file_document_begin_results(document, normals, tangents, error);
}

/* Copies vectors that are marked as changed, rounded to their types. */
static void write_vectors(double *results, const ply_type types[3], size_t first, size_t count,
                          const double *xyz, const uint8_t *changed)
{
    for (size_t i = 0; results && i < count; i++)
        for (size_t a = 0; a < 3 && changed[i]; a++)
            results[3 * (first + i) + a] = ply_round(types[a], xyz[3 * i + a]);
}

void ffd_ply_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    const ply_document *d = ffd_ply_of(document);
    (void)part;
    write_vectors(d->file.new_positions, d->types, first, count, xyz, changed);
}

void ffd_ply_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    const ply_document *d = ffd_ply_of(document);
    (void)part;
    write_vectors(d->file.new_directions, d->types + PLY_NORMAL_SLOT, first, count, xyz, changed);
}
