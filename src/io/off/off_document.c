#include "io/off/off_document.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

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

static void describe_part(off_document *d)
{
    d->part = (mesh_part){.vertex_count = d->header.vertices,
                          .normal_count = d->directions ? d->header.vertices : 0,
                          .identity = true};
    d->base = (mesh_document){.parts = &d->part, .part_count = 1};
}

static void free_document(off_document *d)
{
    ffd_free(d->name);
    ffd_free(d->positions);
    ffd_free(d->directions);
    ffd_free(d->new_positions);
    ffd_free(d->new_directions);
    ffd_free(d);
}

ffd_status ffd_off_open(file_input *input, const ffd_source *source, mesh_document **document,
                        ffd_error *error)
{
    off_document *d = ffd_alloc_zero(1, sizeof *d);
    if (!d)
        return ffd_fail_memory(error);
    d->input = *input;
    d->name = ffd_text_copy(ffd_path_display_name(source->path));
    ffd_status status =
        d->name ? ffd_off_header_read(&d->input, d->name, &d->header, error) : ffd_fail_memory(error);
    if (status == FFD_OK)
        status = read_body(d, error);
    if (status) {
        free_document(d);
        return status;
    }
    describe_part(d);
    d->base.budget = ffd_budget_for_file(d->input.size, true, source->memory);
    *document = &d->base;
    return FFD_OK;
}

void ffd_off_close(mesh_document *document)
{
    off_document *d = (off_document *)document;
    if (!d)
        return;
    ffd_file_unload(&d->input);
    free_document(d);
}
