/* volume_results.c - stores the results of a volume mesh, and writes its file with them. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/volume/volume_document.h"
#include <math.h>
#include <string.h>

/* A displacement out of the plane of a flat mesh, relative to the diagonal of the mesh, that is rounding. */
#define FLAT_TOLERANCE 1e-12
/* Arrays that a warning names. */
#define NAMED ((size_t)8)

static double diagonal_of(const volume_document *d)
{
    double low[3] = {0}, high[3] = {0}, side[3] = {0};
    for (size_t v = 0; v < d->file.part.vertex_count; v++)
        for (int a = 0; a < 2; a++) {
            const double x = d->file.positions[3 * v + a];
            low[a] = v == 0 || x < low[a] ? x : low[a];
            high[a] = v == 0 || x > high[a] ? x : high[a];
        }
    for (int a = 0; a < 2; a++)
        side[a] = high[a] - low[a];
    return vec_length(side);
}

ffd_status ffd_volume_begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    volume_document *const d = (volume_document *)document;
    d->turns = results->directions;
    atomic_store(&d->flattened, 0);
    if (d->dimensions == 2)
        d->flat_limit = FLAT_TOLERANCE * diagonal_of(d);
    return ffd_file_document_begin_results(document, results, error);
}

/* Rounds to the types of the file. */
void ffd_volume_write(mesh_document *document, size_t part, mesh_stream stream, size_t first, size_t count,
                      const double *xyz, const uint8_t *changed)
{
    volume_document *const d = (volume_document *)document;
    const bool is_point = stream == MESH_POSITIONS, is_flat = is_point && d->dimensions == 2;
    double *const results = is_point ? d->file.new_positions : d->file.new_directions;
    const number_type type = is_point ? d->point_type : d->normal_type;
    size_t flattened = 0;
    (void)part;
    for (size_t i = 0; results && i < count; i++) {
        for (size_t a = 0; a < (is_flat ? 2 : 3) && changed[i]; a++)
            results[3 * (first + i) + a] = number_round(type, xyz[3 * i + a]);
        flattened += is_flat && changed[i] && !(fabs(xyz[3 * i + 2]) <= d->flat_limit);
    }
    if (flattened)
        atomic_fetch_add(&d->flattened, flattened);
}

static void add_names(const volume_document *d, bool of_cells, byte_buffer *text, size_t *count)
{
    for (size_t i = 0; i < d->array_count; i++) {
        const volume_array *const array = &d->arrays[i];
        if (array->run.width == 3 && array->of_cells == of_cells && (*count)++ < NAMED)
            ffd_buffer_format(text, "%s\"%s\"%s", *count > 1 ? ", " : "", ffd_text_shown(array->name).text,
                              of_cells ? " of cells" : "");
    }
}

void ffd_volume_warn_kept(const volume_document *d, const mesh_log *log)
{
    byte_buffer text = {0};
    size_t count = 0;
    if (memcmp(d->file.positions, d->file.new_positions, 3 * d->file.part.vertex_count * sizeof(double)) == 0)
        return;
    add_names(d, false, &text, &count);
    add_names(d, true, &text, &count);
    if (count > NAMED)
        ffd_buffer_format(&text, " and %zu more", count - NAMED);
    char *const named = count ? ffd_buffer_finish(&text) : NULL;
    if (named)
        ffd_log_line(log, FFD_LOG_WARNING, "%s of three components %s as %s: %s",
                     count == 1 ? "this array" : "these arrays", count == 1 ? "stays" : "stay",
                     count == 1 ? "it is" : "they are", named);
    ffd_free(named);
    if (d->kept)
        ffd_log_line(log, FFD_LOG_WARNING, "%s", d->kept);
}

static void warn_flattened(volume_document *d, const mesh_log *log)
{
    const size_t count = atomic_load(&d->flattened);
    if (count)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the mesh has two dimensions: displacements along z are left out, of %zu %s", count,
                     count == 1 ? "vertex" : "vertices");
}

ffd_status ffd_volume_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                           const mesh_log *log, ffd_error *error)
{
    volume_document *const d = (volume_document *)document;
    const file_document *const file = &d->file;
    file_splice splice;
    if (!output)
        return FFD_OK;
    ffd_splice_begin(&splice, file, options, output, error);
    for (size_t i = 0; i < d->piece_count && file->new_positions && splice.status == FFD_OK; i++) {
        const volume_piece *const piece = &d->pieces[i];
        const size_t at = 3 * piece->vertex;
        if (piece->stream == MESH_POSITIONS)
            ffd_run_splice(&piece->run, file->positions + at, file->new_positions + at, 3, &splice);
        else if (file->new_directions)
            ffd_run_splice(&piece->run, file->directions + at, file->new_directions + at, 3, &splice);
    }
    if (file->new_positions) {
        warn_flattened(d, log);
        ffd_volume_warn_kept(d, log);
    }
    return ffd_splice_end(&splice);
}
