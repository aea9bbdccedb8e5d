/* off_save.c - writes an OFF file with its results. */
#include "io/off/off_document.h"
#include "io/text/splice.h"
#include "io/text/vectors.h"

static void replace_numbers(file_splice *splice, const text_word *words, const double *before,
                            const double *after, decimal_run *run)
{
    ffd_splice_numbers(splice, words, after, ffd_vectors_changes(before, after, 3), 3, run);
}

static void write_vertices(const off_document *d, file_splice *splice)
{
    off_walk walk;
    off_vertex vertex;
    decimal_run positions, directions;
    ffd_off_walk_begin(&d->header, &walk);
    ffd_decimal_run_begin(&positions, d->file.new_positions + 3 * d->header.vertices);
    if (d->file.new_directions)
        ffd_decimal_run_begin(&directions, d->file.new_directions + 3 * d->header.vertices);
    for (size_t i = 0; splice->status == FFD_OK && i < d->header.vertices; i++) {
        if (!ffd_off_walk_vertex(&walk, &vertex) || vertex.found < off_vertex_width(&d->header)) {
            splice->status = ffd_file_document_changed(&d->file, splice->error);
            return;
        }
        replace_numbers(splice, vertex.numbers, d->file.positions + 3 * i, d->file.new_positions + 3 * i,
                        &positions);
        if (d->file.new_directions)
            replace_numbers(splice, vertex.numbers + 3, d->file.directions + 3 * i,
                            d->file.new_directions + 3 * i, &directions);
    }
}

ffd_status ffd_off_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    file_splice splice;
    (void)log;
    if (!output)
        return FFD_OK;
    ffd_splice_begin(&splice, &d->file, options, output, error);
    if (d->file.new_positions)
        write_vertices(d, &splice);
    return ffd_splice_end(&splice);
}
