#include "io/volume/volume_document.h"
#include "base/memory/memory.h"
#include <float.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

volume_document *ffd_volume_make(size_t size, const file_input *input, const ffd_source *source,
                                 ffd_error *error)
{
    volume_document *const d = ffd_file_document_make(size, input, source, error);
    if (d) {
        d->file.base.budget = ffd_budget_for_file(input->size, true, source->memory); /* while it is read */
        d->dimensions = 3;
        d->point_type = d->normal_type = NUMBER_DOUBLE;
        atomic_init(&d->flattened, 0);
    }
    return d;
}

static void free_content(volume_document *d)
{
    for (size_t g = 0; g < d->group_count; g++)
        ffd_free(d->groups[g].vertices);
    ffd_intern_free(&d->group_names);
    ffd_free(d->groups);
    ffd_free(d->arrays);
    ffd_free(d->pieces);
    ffd_free(d->spans);
    ffd_free(d->selected);
    ffd_free(d->outer.ends);
    ffd_free(d->outer.corners);
    ffd_cells_free(&d->cells);
}

void ffd_volume_free(volume_document *d)
{
    free_content(d);
    ffd_file_document_free(&d->file);
}

void ffd_volume_close(mesh_document *document)
{
    if (document)
        free_content((volume_document *)document);
    ffd_file_document_close(document);
}

static int compare_spans(const void *a, const void *b)
{
    const volume_span *const x = a, *const y = b;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* The memory for cells and outer faces exists already. */
static void take_cells(volume_document *d)
{
    memory_budget *const budget = &d->file.base.budget;
    budget->taken += (uint64_t)d->cells.word_capacity * sizeof *d->cells.words;
    budget->taken += (uint64_t)d->cells.end_capacity * sizeof *d->cells.ends;
    budget->taken += (uint64_t)d->outer.count * sizeof *d->outer.ends;
    if (d->outer.count)
        budget->taken += (uint64_t)d->outer.ends[d->outer.count - 1] * sizeof *d->outer.corners;
}

mesh_document *ffd_volume_ready(volume_document *d, bool text, const ffd_source *source)
{
    const bool is_float = d->point_type == NUMBER_FLOAT;
    mesh_document *const document = ffd_file_document_ready(&d->file, text, source);
    for (int a = 0; a < 3; a++)
        d->file.part.rounding.is_float[a] = is_float;
    d->file.part.normal_count = d->file.directions ? d->file.part.vertex_count : 0;
    d->file.base.largest_coordinate = is_float ? FLT_MAX : DBL_MAX;
    take_cells(d);
    if (d->span_count > 1)
        qsort(d->spans, d->span_count, sizeof *d->spans, compare_spans);
    return document;
}

ffd_status ffd_volume_make_points(volume_document *d, uint64_t count, size_t line, ffd_error *error)
{
    if (count > VOLUME_VERTICES_MAX)
        return ffd_fail_line(error, FFD_E_LIMIT, d->file.name, line,
                             "the mesh has %" PRIu64 " points; at most %" PRIu64 " are supported", count,
                             (uint64_t)VOLUME_VERTICES_MAX);
    d->file.part.vertex_count = (size_t)count;
    d->file.positions = ffd_alloc((size_t)count, 3 * sizeof *d->file.positions);
    return d->file.positions ? FFD_OK : ffd_fail_memory(error);
}

/* Gives points of two numbers a third one, 0. */
static void spread(double *points, size_t count)
{
    for (size_t i = count; i-- > 0;) {
        const double x = points[2 * i], y = points[2 * i + 1];
        points[3 * i] = x;
        points[3 * i + 1] = y;
        points[3 * i + 2] = 0;
    }
}

ffd_status ffd_volume_add_piece(volume_document *d, mesh_stream stream, size_t vertex, const number_run *run,
                                const char **last, size_t *line, ffd_error *error)
{
    const bool is_point = stream == MESH_POSITIONS;
    double *const values = is_point ? d->file.positions : d->file.directions;
    if (!ffd_grow((void **)&d->pieces, &d->piece_capacity, d->piece_count + 1, sizeof *d->pieces))
        return ffd_fail_memory(error);
    TRY(ffd_run_read(run, d->file.name, is_point ? "point" : "normal", values + 3 * vertex, last, line,
                     error));
    if (run->width == 2)
        spread(values + 3 * vertex, run->count);
    d->pieces[d->piece_count++] = (volume_piece){*run, stream, vertex};
    TRY(ffd_volume_add_span(d, run->first, *last, error));
    if (is_point)
        d->point_type = run->type;
    else
        d->normal_type = run->type;
    return FFD_OK;
}

ffd_status ffd_volume_add_span(volume_document *d, const char *first, const char *last, ffd_error *error)
{
    if (!ffd_grow((void **)&d->spans, &d->span_capacity, d->span_count + 1, sizeof *d->spans))
        return ffd_fail_memory(error);
    d->spans[d->span_count++] = (volume_span){first, last};
    return FFD_OK;
}

ffd_status ffd_volume_add_array(volume_document *d, text_word name, const number_run *run, bool of_cells,
                                ffd_error *error)
{
    if (!ffd_grow((void **)&d->arrays, &d->array_capacity, d->array_count + 1, sizeof *d->arrays))
        return ffd_fail_memory(error);
    d->arrays[d->array_count++] = (volume_array){name, *run, of_cells};
    return FFD_OK;
}

ffd_status ffd_volume_group(volume_document *d, const char *name, size_t size, size_t *group,
                            ffd_error *error)
{
    uint32_t index;
    if (!ffd_intern(&d->group_names, name, size, &index))
        return ffd_fail_memory(error);
    *group = index;
    if (index < d->group_count)
        return FFD_OK;
    if (!ffd_grow((void **)&d->groups, &d->group_capacity, d->group_count + 1, sizeof *d->groups))
        return ffd_fail_memory(error);
    d->groups[d->group_count++] = (volume_group){0};
    return FFD_OK;
}

ffd_status ffd_volume_group_add(volume_document *d, size_t group, uint32_t vertex, ffd_error *error)
{
    volume_group *const g = &d->groups[group];
    /* A short file may name the same vertices in any number of groups. */
    TRY(ffd_budget_check(&d->file.base.budget, ++d->grouped, 2 * sizeof *g->vertices, error));
    if (!ffd_grow((void **)&g->vertices, &g->capacity, g->count + 1, sizeof *g->vertices))
        return ffd_fail_memory(error);
    g->vertices[g->count++] = vertex;
    return FFD_OK;
}

ffd_status ffd_volume_at_line(const volume_document *d, size_t line, ffd_status status, ffd_error *error)
{
    if (!status || !error || status == FFD_E_MEMORY || *error->file)
        return status;
    const ffd_error own = *error;
    return ffd_fail_line(error, status, d->file.name, line, "%s", own.message);
}
