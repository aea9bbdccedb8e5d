/* ply_save.c - writes a PLY file with its results. */
#include "io/ply/ply_save.h"
#include "io/ply/ply_textures.h"

/* Writes everything that changes, in the order of the file. Returns the number of splats whose harmonics stay
   because their types cannot hold the results. */
static size_t write_elements(const ply_document *d, file_splice *splice)
{
    size_t unturned = 0;
    for (size_t i = 0; i < d->header.element_count && splice->status == FFD_OK; i++) {
        const ply_element *const element = &d->header.elements[i];
        if (element == d->vertex)
            unturned = d->has_fixed_rows ? ffd_ply_write_fixed(d, splice) : ffd_ply_write_walked(d, splice);
        else if (element == d->face && d->face_normals[0] && d->renew_normals)
            ffd_ply_write_face_normals(d, splice);
    }
    return unturned;
}

ffd_status ffd_ply_check_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                              const mesh_log *log, ffd_error *error)
{
    return ffd_ply_bring_textures(&ffd_ply_of(document)->header, &document->folder, options, output, log,
                                  error);
}

ffd_status ffd_ply_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    file_splice splice;
    const ffd_status status =
        ffd_ply_bring_textures(&d->header, &document->folder, options, output, log, error);
    if (status)
        return status;
    ffd_splice_begin(&splice, &d->file, options, output, error);
    const size_t unturned = d->file.new_positions ? write_elements(d, &splice) : 0;
    if (unturned > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu Gaussian splat%s spherical harmonics that are not numbers, or too large: they are "
                     "not turned",
                     unturned, unturned == 1 ? " has" : "s have");
    if (d->file.new_positions && d->renew_normals)
        ffd_ply_warn_stale(d, log);
    return ffd_splice_end(&splice);
}
