#include "job/author/fit_input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/npy/npy.h"
#include "job/input/selection.h"
#include "job/input/source.h"
#include "job/reads.h"
#include "mesh/bounds.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The limit of memory grows with the files that are read. */
static void give_room(fit_input *input, uint64_t size)
{
    memory_budget budget = ffd_budget_make(0);
    const uint64_t least = ffd_budget_most(&budget);
    ffd_budget_add_file(&budget, size, 0);
    input->room += ffd_budget_most(&budget) - least;
}

static ffd_status open_mesh(const fit_input *input, const ffd_source *source, mesh_document **document,
                            ffd_error *error)
{
    TRY(ffd_source_open(source, input->author->desc.threads, document, error));
    ffd_status status = ffd_mesh_check(*document, error);
    if (!status)
        status = ffd_mesh_warn(*document, &input->author->log, error);
    if (!status && !input->author->desc.sink)
        status = ffd_job_check_mesh_files(input->author->desc.output, source, *document, error);
    if (status)
        ffd_source_close(document);
    else
        ffd_flaws_warn(&(*document)->flaws, ffd_source_name(source), &input->author->log);
    return status;
}

/* Reads all positions, in the order of `ffd embed`. *places: freed by the caller. */
static ffd_status read_positions(mesh_document *document, size_t count, double **places, ffd_error *error)
{
    double *at;
    TRY(ffd_budget_take(&document->budget, count, 3 * sizeof *at, error));
    at = *places = ffd_alloc(count, 3 * sizeof *at);
    if (!at)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions)
            continue;
        ffd_source_positions(document, MESH_STORED, i, 0, part->vertex_count, at);
        at += 3 * part->vertex_count;
    }
    return FFD_OK;
}

static ffd_status check_finite(const double *places, size_t count, const char *name, ffd_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!vec_is_finite(places + 3 * i))
            return ffd_fail_file(error, FFD_E_INVALID, name, "vertex %zu has a coordinate that is not finite",
                                 i);
    return FFD_OK;
}

static ffd_status refuse_count(const fit_input *input, uint64_t vertices, uint64_t count, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, ffd_source_name(&input->after),
                         "has %" PRIu64 " vertices, but %s has %" PRIu64, count,
                         ffd_file_display_name(ffd_source_name(&input->before)), vertices);
}

bool ffd_fit_is_array(const ffd_source *source)
{
    return ffd_path_has_ending(source->path, ".npy");
}

/* Reads places from an array. *places: freed by the caller, in every case. */
static ffd_status read_array(fit_input *input, const ffd_source *source, double **places, size_t *count,
                             ffd_error *error)
{
    file_input file;
    npy_array array = {.dimensions = 0};
    TRY(ffd_file_take(source->path, source->bytes, &file, error));
    give_room(input, file.size);
    ffd_status status = ffd_npy_read_array(&file, source->path, UINT64_MAX, &array, error);
    *places = array.values;
    if (!status && (array.dimensions != 2 || array.shape[1] != 3))
        status = ffd_fail_file(error, FFD_E_INVALID, source->path, "has the shape %s, but places need (N, 3)",
                               array.text);
    *count = status ? 0 : array.shape[0];
    ffd_file_unload(&file);
    return status;
}

static ffd_status read_mesh(fit_input *input, size_t vertices, ffd_error *error)
{
    mesh_document *document;
    TRY(open_mesh(input, &input->after, &document, error));
    input->room += document->budget.most - ffd_budget_make(0).most;
    const uint64_t count = ffd_mesh_vertex_count(document);
    const ffd_status status = count == vertices ? read_positions(document, vertices, &input->targets, error)
                                                : refuse_count(input, vertices, count, error);
    ffd_source_close(&document);
    return status;
}

static ffd_status read_after(fit_input *input, size_t vertices, ffd_error *error)
{
    size_t count = vertices;
    TRY(ffd_fit_is_array(&input->after) ? read_array(input, &input->after, &input->targets, &count, error)
                                        : read_mesh(input, vertices, error));
    if (count != vertices)
        return refuse_count(input, vertices, count, error);
    return check_finite(input->targets, vertices, ffd_source_name(&input->after), error);
}

/* Fills the weights of a file. */
static ffd_status read_weights(const fit_input *input, double *weights, ffd_error *error)
{
    const char *const name = input->job->weights;
    TRY(ffd_npy_read_column(name, input->job->weights_bytes, input->count, weights, error));
    for (size_t i = 0; i < input->count; i++)
        if (!(weights[i] >= 0 && isfinite(weights[i])))
            return ffd_fail_file(error, FFD_E_INVALID, name,
                                 "the weight of vertex %zu is %g, but weights are finite and at least 0", i,
                                 weights[i]);
    return FFD_OK;
}

static ffd_status refuse_weights(const fit_input *input, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, ffd_source_name(&input->before),
                         "no vertex has a weight above 0");
}

/* Leaves out the vertices that are not selected, and counts the others that weigh nothing. *are_left: some
   weigh something. */
static void select_weights(const mesh_document *document, double *weights, size_t *weightless, bool *are_left)
{
    *are_left = false;
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        for (size_t v = 0; v < part->vertex_count && !part->repeats_positions; v++, weights++) {
            const bool is_selected = ffd_part_selects(part, v);
            *weightless += is_selected && *weights == 0;
            *weights = is_selected ? *weights : 0;
            *are_left = *are_left || *weights > 0;
        }
    }
}

static ffd_status weigh_vertices(fit_input *input, mesh_document *document, ffd_error *error)
{
    const char *const how = input->job->weights;
    const bool by_area = !how || strcmp(how, "area") == 0, is_uniform = how && strcmp(how, "uniform") == 0;
    size_t weightless = 0;
    bool are_there = false;
    double *const weights = input->weights = ffd_alloc(input->count, sizeof *weights);
    if (!weights)
        return ffd_fail_memory(error);
    if (by_area)
        TRY(ffd_fit_area_weights(document, weights, &are_there, error));
    for (size_t i = 0; i < input->count && (is_uniform || (by_area && !are_there)); i++)
        weights[i] = 1;
    if (!by_area && !is_uniform)
        TRY(read_weights(input, weights, error));
    select_weights(document, weights, &weightless, &are_there);
    input->weightless = by_area ? weightless : 0;
    return are_there ? FFD_OK : refuse_weights(input, error);
}

/* Takes the places of vertices that rows name. */
static ffd_status take_vertices(fit_input *input, const double *positions, size_t vertices, ffd_error *error)
{
    const fit_table *const table = &input->table;
    input->sources = ffd_alloc(table->count, 3 * sizeof *input->sources);
    if (!input->sources)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < table->count; i++) {
        if (table->vertices[i] >= vertices)
            return ffd_fail_line(error, FFD_E_INVALID, input->name, table->lines[i],
                                 "there is no vertex %zu: %s has %zu", table->vertices[i],
                                 ffd_file_display_name(ffd_source_name(&input->before)), vertices);
        memcpy(input->sources + 3 * i, positions + 3 * table->vertices[i], 3 * sizeof *positions);
    }
    return FFD_OK;
}

/* Context of a walk over a part: which of its positions a lattice goes round. */
typedef struct walk {
    fit_input *input;
    const mesh_part *part;
    bool all;
} walk;

static bool add_place(void *context, size_t vertex, const double place[3])
{
    const walk *const of = context;
    fit_input *const input = of->input;
    if (!ffd_part_selects(of->part, vertex) || !(of->all || ffd_part_shows(of->part, vertex)))
        return true;
    if (!ffd_grow((void **)&input->places, &input->place_capacity, input->place_count + 1, 3 * sizeof *place))
        return false;
    memcpy(input->places + 3 * input->place_count++, place, 3 * sizeof *place);
    return true;
}

/* Adds what a lattice goes round in a document: its box and, for one that is made here, its places. Of one
   that shows nothing these are all. */
static ffd_status go_round(fit_input *input, mesh_document *document, ffd_error *error)
{
    const size_t before = input->place_count;
    TRY(ffd_mesh_mark_used(document, error));
    ffd_shown_box_add_document(&input->box.box, document);
    if (input->author->lattice_count > 0)
        return FFD_OK;
    for (int all = 0; all < 2 && input->place_count == before; all++)
        for (size_t i = 0; i < document->part_count; i++) {
            walk of = {input, &document->parts[i], all};
            if (!of.part->repeats_positions && !ffd_source_visit_places(document, i, add_place, &of))
                return ffd_fail_memory(error);
        }
    return FFD_OK;
}

/* The same for places of no mesh. */
static ffd_status go_round_places(fit_input *input, const double *places, size_t count, ffd_error *error)
{
    shown_box *const box = &input->box.box;
    input->places = ffd_alloc(count, 3 * sizeof *input->places);
    if (!input->places)
        return ffd_fail_memory(error);
    memcpy(input->places, places, 3 * count * sizeof *input->places);
    input->place_count = input->place_capacity = count;
    for (size_t i = 0; i < count; i++) {
        ffd_bounds_widen(&box->shown, places + 3 * i);
        ffd_bounds_widen(&box->all, places + 3 * i);
        ffd_bounds_widen(&box->shape_shown, places + 3 * i);
        ffd_bounds_widen(&box->shape_all, places + 3 * i);
        ffd_bounds_widen(&input->bounds, places + 3 * i);
    }
    return FFD_OK;
}

static ffd_status go_round_covers(fit_input *input, ffd_error *error)
{
    for (size_t i = 0; i < input->author->desc.mesh_count; i++) {
        const ffd_source *const mesh = &input->author->meshes[i];
        mesh_document *document;
        ffd_status status = open_mesh(input, mesh, &document, error);
        if (!status)
            status = go_round(input, document, error);
        if (!status && !mesh->bytes.data)
            status = ffd_source_files(mesh, document, &input->box.files, error);
        ffd_source_close(&document);
        if (status) {
            ffd_fail_name_file(error, ffd_source_name(mesh));
            return status;
        }
    }
    return FFD_OK;
}

/* Instances that a glTF's extension places in the scene have no vertices of their own. */
static ffd_status refuse_instances(const mesh_document *document, ffd_error *error)
{
    const ffd_bounds everywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    return document->format->check_reach ? document->format->check_reach(document, &everywhere, error)
                                         : FFD_OK;
}

/* Takes the pairs of a mesh: all of its vertices, or those that rows name. */
static ffd_status take_mesh(fit_input *input, mesh_document *document, ffd_error *error)
{
    const uint64_t vertices = ffd_mesh_vertex_count(document);
    const char *const name = ffd_source_name(&input->before);
    double *positions = NULL;
    ffd_status status;
    if (vertices == 0)
        TRY(ffd_fail_file(error, FFD_E_INVALID, name, "there are no vertices"));
    TRY_END(ffd_selection_apply(input->only, input->only_count, name, document, error));
    TRY_END(refuse_instances(document, error));
    input->room += document->budget.most - ffd_budget_make(0).most;
    TRY_END(read_positions(document, (size_t)vertices, &positions, error));
    TRY_END(check_finite(positions, (size_t)vertices, name, error));
    for (size_t i = 0; i < vertices; i++)
        ffd_bounds_widen(&input->bounds, positions + 3 * i);
    TRY_END(go_round(input, document, error));
    if (input->table.vertices)
        TRY_END(take_vertices(input, positions, (size_t)vertices, error));
    if (input->table.count == 0) {
        input->count = (size_t)vertices;
        input->sources = positions;
        positions = NULL;
        TRY_END(weigh_vertices(input, document, error));
    }
end:
    ffd_free(positions);
    return status;
}

static ffd_status read_document(fit_input *input, ffd_error *error)
{
    mesh_document *document;
    TRY(open_mesh(input, &input->before, &document, error));
    const ffd_status status = take_mesh(input, document, error);
    ffd_source_close(&document);
    return status;
}

/* Takes the weights of an array of places: it has no faces. */
static ffd_status weigh_places(fit_input *input, ffd_error *error)
{
    const char *const how = input->job->weights;
    if (!how || strcmp(how, "area") == 0 || strcmp(how, "uniform") == 0)
        return FFD_OK;
    input->weights = ffd_alloc(input->count, sizeof *input->weights);
    if (!input->weights)
        return ffd_fail_memory(error);
    TRY(read_weights(input, input->weights, error));
    for (size_t i = 0; i < input->count; i++)
        if (input->weights[i] > 0)
            return FFD_OK;
    return refuse_weights(input, error);
}

/* Takes the pairs of an array of places: all of them, or those that rows name. */
static ffd_status take_array(fit_input *input, ffd_error *error)
{
    const char *const name = input->before.path;
    double *places = NULL;
    size_t count;
    ffd_status status;
    TRY_END(read_array(input, &input->before, &places, &count, error));
    if (count == 0)
        TRY_END(ffd_fail_file(error, FFD_E_INVALID, name, "there are no places"));
    TRY_END(check_finite(places, count, name, error));
    TRY_END(go_round_places(input, places, count, error));
    if (input->table.vertices)
        TRY_END(take_vertices(input, places, count, error));
    if (input->table.count == 0) {
        input->count = count;
        input->sources = places;
        places = NULL;
        TRY_END(weigh_places(input, error));
    }
end:
    ffd_free(places);
    return status;
}

static ffd_status read_before(fit_input *input, ffd_error *error)
{
    return ffd_fit_is_array(&input->before) ? take_array(input, error) : read_document(input, error);
}

static ffd_status read_table(fit_input *input, ffd_error *error)
{
    file_input file;
    TRY(ffd_file_take(input->job->pairs, input->job->pairs_bytes, &file, error));
    give_room(input, file.size);
    const ffd_status status = ffd_fit_table_read(&file, input->name, &input->table, error);
    ffd_file_unload(&file);
    TRY(status);
    if (input->table.vertices && !input->job->before)
        return ffd_fail_file(error, FFD_E_ARGUMENT, input->name,
                             "names vertices, but no mesh is given that has them ({before})");
    input->count = input->table.count;
    return FFD_OK;
}

ffd_status ffd_fit_input_read(fit_input *input, ffd_error *error)
{
    ffd_shown_box_clear(&input->box.box);
    input->bounds = ffd_bounds_empty();
    if (input->job->pairs)
        TRY(read_table(input, error));
    if (input->job->before)
        TRY(read_before(input, error));
    if (input->job->after)
        TRY(read_after(input, input->count, error));
    if (!input->sources) {
        input->sources = input->table.sources;
        input->table.sources = NULL;
    }
    if (input->job->pairs) {
        input->targets = input->table.targets;
        input->weights = input->table.weights;
        input->table.targets = input->table.weights = NULL;
    }
    if (!input->job->before)
        TRY(go_round_places(input, input->sources, input->count, error));
    return go_round_covers(input, error);
}

void ffd_fit_input_free(fit_input *input)
{
    ffd_fit_table_free(&input->table);
    ffd_free(input->sources);
    ffd_free(input->targets);
    ffd_free(input->weights);
    ffd_free(input->places);
    ffd_paths_free(&input->box.files);
}
