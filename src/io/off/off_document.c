#include "io/off/off_document.h"

static ffd_status read_body(off_document *d, ffd_error *error)
{
    off_walk walk;
    ffd_off_walk_begin(&d->header, &walk);
    ffd_status status = ffd_off_read_vertices(d, &walk, error);
    if (status == FFD_OK)
        status = ffd_off_read_faces(d, &walk, error);
    if (status)
        return status;
    ffd_text_next_line(&walk.scan);
    ffd_text_find(&walk.scan); /* empty lines and comments are nothing that stands behind */
    d->behind = walk.scan.at;
    return FFD_OK;
}

ffd_status ffd_off_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    off_document *d = ffd_file_document_make(sizeof *d, input, source, error);
    if (!d)
        return FFD_E_MEMORY;
    ffd_status status = ffd_off_header_read(&d->file.input, d->file.name, &d->header, error);
    if (status == FFD_OK)
        status = read_body(d, error);
    if (status) {
        ffd_file_document_free(&d->file);
        return status;
    }
    d->file.part.vertex_count = d->header.vertices;
    d->file.part.normal_count = d->file.directions ? d->header.vertices : 0;
    *document = ffd_file_document_ready(&d->file, true, source);
    return FFD_OK;
}
