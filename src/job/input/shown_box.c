#include "job/input/shown_box.h"
#include "base/file/mapping.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/selection.h"
#include "job/input/source.h"
#include "mesh/bounds.h"

/* Vertices that are read at once. */
#define BLOCK 256

static bool is_empty(const ffd_bounds *box)
{
    return !(box->min[0] <= box->max[0]);
}

static void join(ffd_bounds *box, const ffd_bounds *other)
{
    if (is_empty(other))
        return;
    ffd_bounds_widen(box, other->min);
    ffd_bounds_widen(box, other->max);
}

void ffd_shown_box_clear(shown_box *box)
{
    box->shown = box->all = box->shape_shown = box->shape_all = ffd_bounds_empty();
}

void ffd_shown_box_join(shown_box *box, const shown_box *other)
{
    join(&box->shown, &other->shown);
    join(&box->all, &other->all);
    join(&box->shape_shown, &other->shape_shown);
    join(&box->shape_all, &other->shape_all);
}

/* A part, and the box of its positions. */
typedef struct part_box {
    const mesh_part *part;
    shown_box *box;
} part_box;

static void widen_by(const part_box *of, size_t vertex, const double place[3], ffd_bounds *all,
                     ffd_bounds *shown)
{
    if (!ffd_part_selects(of->part, vertex) || !vec_is_finite(place))
        return;
    ffd_bounds_widen(all, place);
    if (ffd_part_shows(of->part, vertex))
        ffd_bounds_widen(shown, place);
}

static bool widen(void *context, size_t vertex, const double place[3])
{
    const part_box *const of = context;
    widen_by(of, vertex, place, &of->box->all, &of->box->shown);
    return true;
}

/* Widens the bounds of the shape shown. */
static void widen_shape(const mesh_document *document, size_t part, const part_box *of)
{
    const size_t vertices = of->part->vertex_count;
    double xyz[3 * BLOCK];
    for (size_t first = 0; first < vertices; first += BLOCK) {
        const size_t left = vertices - first, count = left < BLOCK ? left : BLOCK;
        ffd_source_positions(document, MESH_SHOWN, part, first, count, xyz);
        for (size_t i = 0; i < count; i++)
            widen_by(of, first + i, xyz + 3 * i, &of->box->shape_all, &of->box->shape_shown);
    }
}

void ffd_shown_box_add_document(shown_box *box, const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++) {
        part_box of = {&document->parts[i], box};
        if (of.part->repeats_positions)
            continue;
        ffd_source_visit_places(document, i, widen, &of);
        widen_shape(document, i, &of);
    }
}

ffd_status ffd_shown_box_add(shown_box *box, const ffd_source *source, const char *const *only,
                             size_t only_count, path_list *files, const mesh_log *log, ffd_error *error)
{
    ffd_source positions = *source;
    const unsigned losses = ffd_mapping_losses();
    mesh_document *document;
    positions.only_positions = true;
    TRY(ffd_source_open(&positions, 0, &document, error));
    ffd_status status;
    TRY_END(ffd_selection_apply(only, only_count, ffd_source_name(source), document, error));
    TRY_END(ffd_mesh_check(document, error));
    TRY_END(ffd_mesh_mark_used(document, error));
    ffd_shown_box_add_document(box, document);
    if (files)
        TRY_END(ffd_source_files(source, document, files, error));
    ffd_flaws_warn(&document->flaws, ffd_source_name(source), log);
end:
    ffd_source_close(&document);
    status = ffd_mapping_judge(losses, status, error);
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(source));
    return status;
}

static const ffd_bounds *choose(const ffd_bounds *shown, const ffd_bounds *all)
{
    static const ffd_bounds unit = {{0, 0, 0}, {1, 1, 1}};
    if (!is_empty(shown))
        return shown;
    return is_empty(all) ? &unit : all;
}

fit_extent ffd_shown_box_extent(const shown_box *box)
{
    return ffd_fit_extent(choose(&box->shown, &box->all), choose(&box->shape_shown, &box->shape_all));
}

ffd_status ffd_shared_box_create(ffd_shared_box **box, ffd_error *error)
{
    *box = ffd_alloc_zero(1, sizeof **box);
    if (!*box)
        return ffd_fail_memory(error);
    ffd_shown_box_clear(&(*box)->box);
    return FFD_OK;
}

ffd_status ffd_shared_box_add(ffd_shared_box *box, const ffd_deform_desc *callers, ffd_error *error)
{
    ffd_deform_desc own;
    const ffd_deform_desc *const desc = &own;
    job_memory memory = {0};
    ffd_status status;
    TRY_END(ffd_deform_desc_take(callers, &own, error));
    TRY_END(ffd_in_memory_source(&memory, &own.input, error));
    if (ffd_file_is_stream(desc->input.path))
        TRY_END(ffd_fail(error, FFD_E_ARGUMENT,
                         "a shared box reads its meshes twice, but standard input can be read only once"));
    TRY_END(
        ffd_shown_box_add(&box->box, &desc->input, desc->only, desc->only_count, &box->files, NULL, error));
end:
    status = ffd_in_memory_end(&memory, status, error);
    return status;
}

void ffd_shared_box_destroy(ffd_shared_box **box)
{
    if (!box || !*box)
        return;
    ffd_paths_free(&(*box)->files);
    ffd_free(*box);
    *box = NULL;
}
