/* volume_faces.c - the faces of a volume mesh, and which of its vertices are used. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/text/vectors.h"
#include "io/volume/volume_document.h"
#include "io/volume/volume_surface.h"
#include "mesh/face_filler.h"
#include "mesh/mixed_faces.h"

static ffd_status visit_outer(const volume_outer *outer, surface_visitor *visit, void *context,
                              ffd_error *error)
{
    for (size_t f = 0; f < outer->count; f++) {
        const size_t first = f ? outer->ends[f - 1] : 0;
        TRY(ffd_deadline_check_at(f, error));
        visit(context, outer->corners + first, outer->ends[f] - first);
    }
    return FFD_OK;
}

static ffd_status visit_faces(const volume_document *d, surface_visitor *visit, void *context,
                              ffd_error *error)
{
    return d->has_outer ? visit_outer(&d->outer, visit, context, error)
                        : ffd_surface_visit(&d->cells, &d->file.base.budget, visit, context, error);
}

/* The edges of these join vertices inside, too. */
static ffd_status visit_sides(const volume_document *d, surface_visitor *visit, void *context,
                              ffd_error *error)
{
    return d->cells.volumes ? ffd_sides_visit(&d->cells, visit, context, error)
                            : visit_faces(d, visit, context, error);
}

typedef ffd_status face_source(const volume_document *d, surface_visitor *visit, void *context,
                               ffd_error *error);

/* Numbers of cells of no and one dimension. */
static void count_cells(const volume_document *d, mesh_faces *faces)
{
    for (size_t c = 0; c < d->cells.count; c++) {
        const uint8_t dimension = ffd_cell_kind(d->cells.kinds[c])->dimension;
        faces->points += dimension == 0;
        faces->lines += dimension == 1;
    }
}

/* Counts faces and corners, and marks the vertices that are in some. */
typedef struct face_counter {
    size_t faces, corners;
    uint8_t *marks;
} face_counter;

static void count_face(void *context, const uint32_t *corners, size_t count)
{
    face_counter *const counter = context;
    counter->faces++;
    counter->corners += count;
    for (size_t c = 0; c < count; c++)
        counter->marks[corners[c]] |= 1;
}

static void mark_point(void *context, uint32_t point)
{
    uint8_t *const marks = context;
    marks[point] |= 2;
}

/* Vertices inside of cells, and between their corners, are in no face; they are not isolated either. Where
   only the outer faces of cells are known, all others are inside. */
static void mark_all(const volume_document *d, uint8_t *marks)
{
    if (d->has_outer && d->lacks_cells)
        for (size_t v = 0; v < d->file.part.vertex_count; v++)
            marks[v] |= 2;
    for (size_t c = 0; c < d->cells.count; c++)
        if (ffd_cell_kind(d->cells.kinds[c])->dimension >= 2)
            ffd_cell_visit(&d->cells, c, mark_point, marks);
}

static void fill_face(void *context, const uint32_t *corners, size_t count)
{
    face_filler *const filler = context;
    ffd_filler_face(filler);
    for (size_t c = 0; c < count; c++)
        ffd_filler_corner(filler, corners[c]);
}

static ffd_status fill_faces(const volume_document *d, face_source *source, face_counter *counter,
                             mesh_faces *faces, ffd_error *error)
{
    const mesh_document *const document = &d->file.base;
    *faces = (mesh_faces){.vertex_count = d->file.part.vertex_count, .face_count = counter->faces};
    count_cells(d, faces);
    mark_all(d, counter->marks);
    for (size_t v = 0; v < faces->vertex_count; v++)
        faces->repeated += counter->marks[v] == 2;
    TRY(ffd_mesh_faces_make(document, faces, counter->corners, error));
    ffd_vectors_read(d->file.positions, 0, faces->vertex_count, faces->positions);
    face_filler filler = {.faces = faces, .corners = counter->corners};
    const ffd_status status = source(d, fill_face, &filler, error);
    if (status) {
        ffd_mesh_faces_free(faces);
        return status;
    }
    return ffd_filler_end(&filler, d->file.name, error);
}

static ffd_status make_faces(const volume_document *d, face_source *source, mesh_faces *faces,
                             ffd_error *error)
{
    face_counter counter = {.marks = ffd_alloc_zero(d->file.part.vertex_count, 1)};
    ffd_status status;
    if (!counter.marks)
        return ffd_fail_memory(error);
    TRY_END(source(d, count_face, &counter, error));
    TRY_END(fill_faces(d, source, &counter, faces, error));
end:
    ffd_free(counter.marks);
    return status;
}

ffd_status ffd_volume_faces(const mesh_document *document, mesh_state state, mesh_faces *faces,
                            ffd_error *error)
{
    (void)state;
    return make_faces(ffd_volume_of(document), visit_faces, faces, error);
}

ffd_status ffd_volume_sides(const mesh_document *document, mesh_state state, mesh_faces *faces,
                            ffd_error *error)
{
    (void)state;
    return make_faces(ffd_volume_of(document), visit_sides, faces, error);
}

typedef struct mixed_list {
    face_list list;
    const vertex_marks *marks;
} mixed_list;

static void add_mixed(void *context, const uint32_t *corners, size_t count)
{
    mixed_list *const mixed = context;
    for (size_t c = 0; c < count; c++)
        ffd_face_list_corner(&mixed->list, corners[c]);
    ffd_face_list_end(&mixed->list, mixed->marks);
}

ffd_status ffd_volume_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                                  mesh_faces *faces, ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    mixed_list mixed = {.marks = marks};
    ffd_status status;
    (void)state;
    *faces = (mesh_faces){.vertex_count = marks->vertices};
    TRY_END(visit_sides(d, add_mixed, &mixed, error));
    TRY_END(ffd_face_lists_narrow(document, &mixed.list, 1, faces, error));
    ffd_file_document_fill_positions(&d->file, faces);
end:
    ffd_free(mixed.list.words);
    return status;
}

ffd_status ffd_volume_mark_used(mesh_document *document, ffd_error *error)
{
    volume_document *const d = (volume_document *)document;
    const size_t count = d->file.part.vertex_count;
    TRY(ffd_used_make(document, count, &d->file.used, error));
    for (size_t c = 0; c < d->cells.count; c++)
        ffd_cell_visit(&d->cells, c, mark_point, d->file.used);
    if (ffd_used_keep(document, count, &d->file.used))
        d->file.part.used = d->file.used;
    return FFD_OK;
}

typedef struct model_filler {
    mesh_model *model;
    model_corner *corners;
    size_t capacity;
    bool has_normals;
    ffd_status status;
    ffd_error *error;
} model_filler;

static void add_element(model_filler *filler, model_kind kind, const uint32_t *corners, size_t count)
{
    if (filler->status)
        return;
    if (!ffd_grow((void **)&filler->corners, &filler->capacity, count, sizeof *filler->corners)) {
        filler->status = ffd_fail_memory(filler->error);
        return;
    }
    for (size_t c = 0; c < count; c++)
        filler->corners[c] =
            (model_corner){corners[c], MODEL_NONE, filler->has_normals ? corners[c] : MODEL_NONE};
    filler->status = ffd_model_add(filler->model, kind, filler->corners, count, filler->error);
}

static void add_model_face(void *context, const uint32_t *corners, size_t count)
{
    add_element(context, MODEL_FACES, corners, count);
}

static ffd_status add_lines(const volume_document *d, model_filler *filler)
{
    for (size_t c = 0; c < d->cells.count && !filler->status; c++) {
        const cell_kind *const kind = ffd_cell_kind(d->cells.kinds[c]);
        size_t count;
        const uint32_t *const points = ffd_cell_words(&d->cells, c, &count);
        /* Of a curve the ends come first. */
        const size_t some = d->cells.kinds[c] == CELL_POLYLINE || count < 2 ? count : 2;
        if (kind->dimension == 1)
            add_element(filler, MODEL_LINES, points, some);
        for (size_t i = 0; i < count && kind->dimension == 0; i++)
            add_element(filler, MODEL_POINTS, points + i, 1);
    }
    return filler->status;
}

ffd_status ffd_volume_model(const mesh_document *document, mesh_state state, mesh_model *model,
                            ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    model_filler filler = {.model = model, .error = error};
    ffd_status status;
    (void)state;
    TRY_END(ffd_file_document_model(&d->file, 0, model, error));
    filler.has_normals = model->normal_count > 0;
    TRY_END(ffd_model_begin_run(model, NULL, NULL, NULL, error));
    TRY_END(visit_faces(d, add_model_face, &filler, error));
    TRY_END(filler.status);
    TRY_END(add_lines(d, &filler));
    TRY_END(ffd_model_finish(model, error));
end:
    ffd_free(filler.corners);
    return status;
}
