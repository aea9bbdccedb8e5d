#include "io/text/file_document.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/text/vectors.h"

void *ffd_file_document_make(size_t size, const file_input *input, const ffd_source *source, ffd_error *error)
{
    file_document *d = ffd_alloc_zero(1, size);
    char *name = ffd_text_copy(ffd_file_display_name(source->path));
    const bool has_folder = !ffd_file_is_stream(source->path);
    char *path = has_folder ? ffd_text_copy(source->path) : NULL;
    if (!d || !name || (has_folder && !path)) {
        ffd_free(d);
        ffd_free(name);
        ffd_free(path);
        ffd_fail_memory(error);
        return NULL;
    }
    d->input = *input;
    d->name = name;
    d->path = path;
    d->base.folder = (file_folder){path, source->resolve, source->resolve_user};
    d->base.flaws.strict = source->strict;
    return d;
}

ffd_status ffd_file_document_note_mark(file_document *d, size_t text_size, ffd_error *error)
{
    if (text_size == d->input.size)
        return FFD_OK;
    return ffd_flaw_line(&d->base.flaws, d->name, 0, error,
                         "a Ctrl-Z, the end mark of old texts, ends the file");
}

mesh_document *ffd_file_document_ready(file_document *d, bool text, const ffd_source *source)
{
    d->part.identity = true;
    d->base.parts = &d->part;
    d->base.part_count = 1;
    d->base.budget = ffd_budget_for_file(d->input.size, text, source->memory);
    return &d->base;
}

void ffd_file_document_free(file_document *d)
{
    ffd_free(d->name);
    ffd_free(d->path);
    ffd_free(d->positions);
    ffd_free(d->directions);
    ffd_free(d->new_positions);
    ffd_free(d->new_directions);
    ffd_free(d->used);
    ffd_free(d);
}

void ffd_file_document_close(mesh_document *document)
{
    file_document *d = (file_document *)document;
    if (!d)
        return;
    ffd_file_unload(&d->input);
    ffd_file_document_free(d);
}

void ffd_file_document_read(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                            size_t first, size_t count, double *xyz)
{
    const file_document *const d = (const file_document *)document;
    (void)part; /* the only one */
    (void)state;
    ffd_vectors_read(stream == MESH_POSITIONS ? d->positions : d->directions, first, count, xyz);
}

/* Vectors compared with zeros at a time: about a memory page. */
#define RUN ((size_t)170)
static const double zeros[3 * RUN];

/* Copies vectors into a zeroed array, but not runs of zeros, so that their pages are not touched. */
static void copy_into_zeros(const double *vectors, size_t count, double *results)
{
    for (size_t first = 0; first < count; first += RUN) {
        const size_t some = count - first < RUN ? count - first : RUN;
        if (memcmp(vectors + 3 * first, zeros, 3 * some * sizeof *zeros) != 0)
            ffd_vectors_read(vectors, first, some, results + 3 * first);
    }
}

/* Makes *results a copy of count vectors, and allocates it unless it exists. In most files the normals of
   splats are zeros: their copy takes no memory until one of them changes. */
static ffd_status copy(const double *vectors, size_t count, double **results, ffd_error *error)
{
    if (*results) {
        ffd_vectors_read(vectors, 0, count, *results);
        return FFD_OK;
    }
    *results = ffd_alloc_sparse(count, 3 * sizeof **results);
    if (!*results)
        return ffd_fail_memory(error);
    copy_into_zeros(vectors, count, *results);
    return FFD_OK;
}

ffd_status ffd_file_document_begin_results(mesh_document *document, const mesh_results *results,
                                           ffd_error *error)
{
    file_document *d = (file_document *)document;
    const ffd_status status = copy(d->positions, d->part.vertex_count, &d->new_positions, error);
    if (status || !results->directions || !d->directions) {
        ffd_free(d->new_directions);
        d->new_directions = NULL;
        return status;
    }
    return copy(d->directions, d->part.normal_count, &d->new_directions, error);
}

void ffd_file_document_write(mesh_document *document, size_t part, mesh_stream stream, size_t first,
                             size_t count, const double *xyz, const uint8_t *changed)
{
    const file_document *const d = (const file_document *)document;
    double *const results = stream == MESH_POSITIONS ? d->new_positions : d->new_directions;
    (void)part;
    for (size_t i = 0; results && i < count; i++)
        if (changed[i])
            memcpy(results + 3 * (first + i), xyz + 3 * i, 3 * sizeof *xyz);
}

ffd_status ffd_file_document_model(const file_document *d, size_t texcoords, mesh_model *model,
                                   ffd_error *error)
{
    const size_t count = d->part.vertex_count;
    const double *positions = d->new_positions ? d->new_positions : d->positions;
    const double *normals = d->new_directions ? d->new_directions : d->directions;
    TRY(ffd_model_make_values(model, count, texcoords, normals ? count : 0, error));
    ffd_vectors_read(positions, 0, count, model->positions);
    ffd_vectors_read(normals, 0, model->normal_count, model->normals);
    return FFD_OK;
}

ffd_status ffd_file_document_changed(const file_document *document, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_IO, document->name, "was changed while it was read");
}

void ffd_file_document_fill_positions(const file_document *d, mesh_faces *faces)
{
    for (size_t c = 0; !faces->vertices && c < faces->start[faces->face_count]; c++) {
        const size_t vertex = faces->corners[c];
        d->base.format->read(&d->base, 0, MESH_POSITIONS, MESH_STORED, vertex, 1,
                             faces->positions + 3 * vertex);
    }
    for (size_t v = 0; faces->vertices && v < faces->vertex_count; v++)
        d->base.format->read(&d->base, 0, MESH_POSITIONS, MESH_STORED, faces->vertices[v], 1,
                             faces->positions + 3 * v);
}
