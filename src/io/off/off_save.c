#include "base/number.h"
#include "io/off/off_document.h"
#include "io/splice.h"
#include <string.h>

/* Replaces those of three numbers that have other bits than before. */
static void replace_numbers(file_splice *splice, const text_word *words, const double *before,
                            const double *after)
{
    for (int a = 0; a < 3; a++) {
        char text[FFD_NUMBER_CAPACITY];
        if (memcmp(before + a, after + a, sizeof *after) != 0)
            ffd_splice_replace(splice, words[a].first, words[a].last, text,
                               ffd_number_format(after[a], text));
    }
}

static void write_vertices(const off_document *d, file_splice *splice)
{
    off_walk walk;
    off_vertex vertex;
    ffd_off_walk_begin(&d->header, &walk);
    for (size_t i = 0; splice->status == FFD_OK && i < d->header.vertices; i++) {
        ffd_off_walk_vertex(&walk, &vertex);
        replace_numbers(splice, vertex.numbers, d->positions + 3 * i, d->new_positions + 3 * i);
        if (d->new_directions)
            replace_numbers(splice, vertex.numbers + 3, d->directions + 3 * i, d->new_directions + 3 * i);
    }
}

ffd_status ffd_off_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    file_splice splice;
    (void)log;
    ffd_status status = ffd_output_begin(output, options->path, options->force, error);
    if (status == FFD_OK)
        status = ffd_splice_begin(&splice, d->input.data, output, error);
    if (status)
        return status;
    if (d->new_positions)
        write_vertices(d, &splice);
    ffd_splice_copy(&splice, (const char *)d->input.data + d->input.size);
    return ffd_splice_end(&splice);
}
