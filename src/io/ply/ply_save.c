/* ply_save.c - writes a PLY file with its results. */
#include "io/ply/ply_save.h"
#include <string.h>

/* Replaces a number whose bits have changed. */
static void replace_number(const ply_document *d, file_splice *splice, const ply_property *property,
                           text_word word, size_t row)
{
    const bool normal = property->slot >= PLY_NORMAL_SLOT;
    const double *before = normal ? d->file.directions : d->file.positions;
    const double *after = normal ? d->file.new_directions : d->file.new_positions;
    const size_t index = 3 * row + property->slot % PLY_NORMAL_SLOT;
    char bytes[FFD_NUMBER_CAPACITY];
    if (!after || memcmp(before + index, after + index, sizeof *after) == 0)
        return;
    const size_t size = ffd_ply_store(d->header.encoding, property->type, after[index], bytes);
    ffd_splice_replace(splice, word, bytes, size);
}

static void write_vertices(const ply_document *d, file_splice *splice)
{
    ply_walk walk;
    ffd_ply_document_walk(d, d->vertex, &walk);
    for (size_t row = 0; splice->status == FFD_OK && row < d->file.part.vertex_count; row++) {
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->vertex->property_count; i++) {
            const ply_property *property = &d->vertex->properties[i];
            text_word word;
            if (property->slot == PLY_NO_SLOT)
                ffd_ply_walk_skip(&walk, property);
            else {
                ffd_ply_walk_value(&walk, property->type, &word);
                replace_number(d, splice, property, word, row);
            }
        }
    }
}

/* What changes, in the order of the file. */
static void write_elements(const ply_document *d, file_splice *splice)
{
    for (size_t i = 0; i < d->header.element_count && splice->status == FFD_OK; i++) {
        const ply_element *const element = &d->header.elements[i];
        if (element == d->vertex)
            write_vertices(d, splice);
        else if (element == d->face && d->face_normals[0] && d->renew_normals)
            ffd_ply_write_face_normals(d, splice);
    }
}

ffd_status ffd_ply_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    file_splice splice;
    ffd_splice_begin(&splice, &d->file.input, options, output, error);
    if (d->file.new_positions)
        write_elements(d, &splice);
    if (d->file.new_positions && d->renew_normals && d->has_whole_face_normals)
        ffd_log_line(log, FFD_LOG_WARNING, "nx ny nz of the faces are not all float or double: they stay");
    return ffd_splice_end(&splice);
}
