/* lattice_new.c - the job of `ffd lattice new`. */
#include "job/lattice_new.h"
#include "base/file/mapping.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "job/chain/lattice_memory.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/selection.h"
#include "job/input/source.h"
#include "job/reads.h"
#include "lattice/file/spec_text.h"
#include "lattice/lattice.h"
#include <math.h>
#include <string.h>

void ffd_lattice_new_desc_init(ffd_lattice_new_desc *desc, size_t size)
{
    const ffd_lattice_new_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* Positions in the lattice's space. */
typedef struct place_list {
    double *xyz; /* 3 numbers each */
    size_t count, capacity;
} place_list;

/* Context of a walk over a part: which positions to list. Of selected vertices, the visible ones or all. */
typedef struct part_places {
    const mesh_part *part;
    bool all;
    place_list *places;
} part_places;

static bool add_place(void *context, size_t vertex, const double place[3])
{
    const part_places *const of = context;
    place_list *const places = of->places;
    if (!ffd_part_selects(of->part, vertex) || (!of->all && !ffd_part_shows(of->part, vertex)))
        return true;
    if (!ffd_grow((void **)&places->xyz, &places->capacity, places->count + 1, 3 * sizeof *places->xyz))
        return false;
    memcpy(places->xyz + 3 * places->count++, place, 3 * sizeof *place);
    return true;
}

static ffd_status list_places(mesh_document *document, bool all, place_list *places, ffd_error *error)
{
    for (size_t i = 0; i < document->part_count; i++) {
        part_places of = {&document->parts[i], all, places};
        if (!of.part->repeats_positions && !ffd_source_visit_places(document, i, add_place, &of))
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

static ffd_status add_mesh(const ffd_lattice_new_desc *desc, const ffd_source *mesh, bool all,
                           place_list *places, ffd_error *error)
{
    static const ffd_bounds everywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    const mesh_log log = {desc->log, desc->log_user};
    mesh_document *document;
    TRY(ffd_source_open(mesh, 0, &document, error));
    ffd_status status;
    TRY_END(ffd_selection_apply(desc->only, desc->only_count, ffd_source_name(mesh), document, error));
    TRY_END(ffd_mesh_check(document, error));
    if (document->format->check_reach)
        TRY_END(document->format->check_reach(document, &everywhere, error));
    TRY_END(ffd_mesh_mark_used(document, error));
    TRY_END(list_places(document, all, places, error));
    if (!all) /* in the second walk they are logged already */
        ffd_flaws_warn(&document->flaws, ffd_source_name(mesh), &log);
end:
    ffd_source_close(&document);
    if (status == FFD_E_INVALID)
        ffd_fail_name_file(error, ffd_source_name(mesh));
    return status;
}

static ffd_status add_meshes(const ffd_lattice_new_desc *desc, bool all, place_list *places, ffd_error *error)
{
    for (size_t i = 0; i < desc->mesh_count; i++)
        TRY(add_mesh(desc, &desc->meshes[i], all, places, error));
    return FFD_OK;
}

/* Invalid sizes and degrees are left to ffd_lattice_create. */
static ffd_status check_memory(const ffd_lattice_new_desc *desc, ffd_error *error)
{
    lattice_spec spec = {.count = 1};
    memory_budget budget = ffd_budget_make(desc->meshes[0].memory);
    for (int a = 0; a < 3; a++) {
        spec.size[a] = desc->lattice->size[a];
        if (spec.size[a] < 1 || spec.size[a] > FFD_MAX_CONTROL_POINTS / spec.count)
            return FFD_OK;
        spec.degree[a] = desc->lattice->degree[a] ? desc->lattice->degree[a] : 3;
        if (spec.degree[a] < 0 || spec.degree[a] > FFD_MAX_DEGREE)
            return FFD_OK;
        spec.count *= spec.size[a];
    }
    return ffd_lattice_memory_take(&budget, &spec, 0, error);
}

static ffd_status list_points(const ffd_lattice_new_desc *desc, place_list *points, ffd_error *error)
{
    TRY(add_meshes(desc, false, points, error));
    if (points->count == 0 && !ffd_file_is_stream(desc->meshes[0].path))
        TRY(add_meshes(desc, true, points, error));
    return FFD_OK;
}

ffd_status ffd_lattice_new_round(const ffd_lattice_new_desc *desc, ffd_lattice **lattice, ffd_error *error)
{
    place_list points = {0};
    TRY(check_memory(desc, error));
    const unsigned losses = ffd_mapping_losses();
    ffd_status status;
    TRY_END(ffd_mapping_judge(losses, list_points(desc, &points, error), error));
    TRY_END(ffd_lattice_create(desc->lattice, points.xyz, points.count, lattice, error));
end:
    ffd_free(points.xyz);
    /* other failures concern the description, not the meshes */
    if (status == FFD_E_INVALID)
        ffd_fail_name_file(error, ffd_source_name(&desc->meshes[0]));
    return status;
}

static ffd_status check_desc(const ffd_lattice_new_desc *desc, ffd_error *error)
{
    bool complete = desc->meshes && desc->mesh_count > 0 && desc->lattice && desc->output &&
                    ffd_desc_has_texts(desc->only, desc->only_count);
    for (size_t i = 0; i < desc->mesh_count && complete; i++)
        complete = desc->meshes[i].path;
    if (!complete)
        return ffd_fail(error, FFD_E_ARGUMENT, "the description of the new lattice is not complete");
    if (desc->sink)
        return FFD_OK;
    for (size_t i = 0; i < desc->mesh_count && !ffd_output_is_stream(desc->output); i++)
        if (ffd_job_reads_mesh(&desc->meshes[i], desc->output))
            return ffd_fail_file(error, FFD_E_ARGUMENT, desc->output, "the lattice would replace its mesh");
    for (size_t i = 0; i < desc->mesh_count; i++)
        TRY(ffd_job_check_mesh_files(desc->output, &desc->meshes[i], NULL, error));
    return ffd_output_check(desc->output, desc->force, error);
}

/* Registers meshes in memory under paths, in a copy of their array (*meshes), which the caller frees. */
static ffd_status take_memory(job_memory *memory, ffd_lattice_new_desc *desc, ffd_source **meshes,
                              ffd_error *error)
{
    const size_t count = desc->meshes ? desc->mesh_count : 0;
    *meshes = ffd_alloc(count, sizeof **meshes);
    if (!*meshes)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        (*meshes)[i] = desc->meshes[i];
        TRY(ffd_in_memory_source(memory, &(*meshes)[i], error));
    }
    desc->meshes = count > 0 ? *meshes : NULL;
    return ffd_in_memory_output(desc->sink, desc->output, error);
}

static ffd_status save(const ffd_lattice_new_desc *desc, const ffd_lattice *lattice, ffd_error *error)
{
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_redirect(output, desc->sink, desc->sink_user);
    ffd_status status = ffd_lattice_write(lattice, output, desc->output, desc->force, error);
    ffd_output_destroy(&output);
    return status;
}

ffd_status ffd_lattice_new_run(const ffd_lattice_new_desc *callers, ffd_error *error)
{
    ffd_lattice_new_desc own;
    const ffd_lattice_new_desc *const desc = &own;
    ffd_lattice *lattice = NULL;
    ffd_lattice_new_desc_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, callers, "ffd_lattice_new_desc", error));
    job_memory memory = {0};
    ffd_source *meshes = NULL;
    ffd_status status;
    TRY_END(take_memory(&memory, &own, &meshes, error));
    TRY_END(check_desc(desc, error));
    TRY_END(ffd_lattice_new_round(desc, &lattice, error));
    TRY_END(save(desc, lattice, error));
end:
    status = ffd_in_memory_end(&memory, status, error);
    ffd_free(meshes);
    ffd_lattice_destroy(&lattice);
    return status;
}
