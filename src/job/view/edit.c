/* edit.c - the job of `ffd edit`: makes a page in which a lattice is shaped. */
#include "job/view/edit.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/source.h"
#include "job/lattice_new.h"
#include "job/pass/chain_fit.h"
#include "job/report/output_set.h"
#include "job/view/view.h"
#include "view/page.h"
#include <inttypes.h>

/* The state of an edit. */
typedef struct edit_work {
    const ffd_edit_desc *desc;
    deform_job job;
    ffd_lattice *made; /* round the mesh; NULL: the caller has lattices */
    mesh_model model;
    view_scene scene;
    uint32_t *faces; /* of each triangle: its polygon */
    edit_counts counts;
} edit_work;

void ffd_edit_desc_init(ffd_edit_desc *desc, size_t size)
{
    const ffd_edit_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static ffd_status check_desc(const ffd_edit_desc *desc, ffd_error *error)
{
    const ffd_deform_desc *const job = desc->job;
    if (!desc->output || !job->input.path)
        return ffd_fail(error, FFD_E_ARGUMENT, "the edit's description is not complete");
    if (desc->lattice && job->lattice_count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "a new lattice is made where none is given, not beside {lattices}");
    if ((int)desc->up < FFD_UP_Y || desc->up > FFD_UP_X)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of up", (int)desc->up);
    if (!ffd_path_has_ending(desc->output, ".html"))
        return ffd_fail_file(error, FFD_E_ARGUMENT, desc->output,
                             "the ending \"%s\" is not that of a page (.html)",
                             ffd_path_ending(desc->output));
    if (desc->sink)
        return FFD_OK;
    const ffd_view_desc view = {.job = job, .output = desc->output};
    TRY(ffd_view_check_inputs(&view, error));
    return ffd_output_check(desc->output, desc->force, error);
}

/* Makes the lattice of a job that has none. */
static ffd_status make_lattice(edit_work *work, ffd_deform_desc *job, ffd_lattice_source *source,
                               ffd_error *error)
{
    ffd_lattice_desc defaults;
    ffd_lattice_desc_init(&defaults, sizeof defaults);
    if (job->lattice_count > 0)
        return FFD_OK;
    const ffd_lattice_new_desc round = {.meshes = &job->input,
                                        .mesh_count = 1,
                                        .only = job->only,
                                        .only_count = job->only_count,
                                        .lattice = work->desc->lattice ? work->desc->lattice : &defaults};
    TRY(ffd_lattice_new_round(&round, &work->made, error));
    *source = (ffd_lattice_source){.path = "round the mesh", .object = work->made};
    job->lattices = source;
    job->lattice_count = 1;
    return FFD_OK;
}

/* Marks the triangles that are of the same polygon as the one before. */
static ffd_status mark_faces(edit_work *work, ffd_error *error)
{
    view_scene *const scene = &work->scene;
    scene->continues = ffd_alloc(scene->triangle_count, 1);
    if (!scene->continues)
        return ffd_fail_memory(error);
    for (size_t t = 0; t < scene->triangle_count; t++)
        scene->continues[t] = t > 0 && work->faces[t] == work->faces[t - 1];
    return FFD_OK;
}

static ffd_status read_mesh(edit_work *work, ffd_error *error)
{
    mesh_document *const document = work->job.document;
    mesh_model *const model = &work->model;
    const mesh_state state = ffd_mesh_shows_shapes(document) ? MESH_SHOWN : MESH_STORED;
    model->budget = &document->budget;
    model->wants_details = true;
    TRY(document->format->model(document, state, model, error));
    if (document->format->list_materials)
        TRY(document->format->list_materials(document, &work->job.log, &work->scene.materials, error));
    TRY(ffd_view_take_mesh(model, &work->scene, &work->faces, &work->job.log, error));
    TRY(ffd_view_place_after(model, NULL, &work->scene, error));
    return mark_faces(work, error);
}

static ffd_status name_scene(edit_work *work, ffd_error *error)
{
    work->scene.name = ffd_text_copy(ffd_path_name(ffd_source_name(&work->desc->job->input)));
    return work->scene.name ? FFD_OK : ffd_fail_memory(error);
}

/* Flaws of the mesh, and what the page leaves out that that of a view has. */
static void warn(const edit_work *work)
{
    const mesh_log *const log = &work->job.log;
    const edit_counts *const counts = &work->counts;
    ffd_flaws_warn(&work->job.document->flaws, NULL, log);
    if (work->scene.splats[0])
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the page moves Gaussian splats, but does not turn or stretch them");
    if (work->model.nodes_left)
        ffd_log_line(log, FFD_LOG_WARNING, "not shown: the GPU instances of %zu %s", work->model.nodes_left,
                     ffd_plural(work->model.nodes_left, "node", "nodes"));
    if (counts->outside > 0 && !work->job.chain.outside.extend)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%" PRIu64 " of %" PRIu64 " vertices are outside of the lattice and stay",
                     counts->outside, counts->inside + counts->outside);
}

/* Places outside are refused where the job says so. */
static ffd_status judge_outside(const edit_work *work, ffd_error *error)
{
    const edit_counts *const counts = &work->counts;
    return counts->outside > 0 && work->job.desc->outside == FFD_OUTSIDE_ERROR
               ? ffd_fail(error, FFD_E_EMBEDDING,
                          "%" PRIu64 " of %" PRIu64 " vertices are outside of the lattice", counts->outside,
                          counts->inside + counts->outside)
               : FFD_OK;
}

static ffd_status make_scene(edit_work *work, ffd_job_result *result, ffd_error *error)
{
    deform_job *const job = &work->job;
    view_edit *edit;
    TRY(ffd_deform_job_open(job, 0, result, error));
    TRY(ffd_mesh_check(job->document, error));
    if (!work->desc->sink)
        TRY(ffd_view_check_files(&job->desc->input, job->document, work->desc->output, error));
    TRY(ffd_chain_fit(&job->chain, job->document, job->threads, NULL, error));
    TRY(name_scene(work, error));
    TRY(read_mesh(work, error));
    TRY(ffd_view_add_splats(job->document, NULL, NULL, &work->scene, error));
    TRY(ffd_view_add_cages(&job->chain, job->desc->lattices, &work->scene, error));
    edit = work->scene.edit = ffd_alloc_zero(1, sizeof *edit);
    if (!edit)
        return ffd_fail_memory(error);
    TRY(ffd_edit_find_points(job, &work->scene, &edit->points, &work->counts, error));
    TRY(ffd_edit_take_lattice(job, &work->scene, edit, error));
    edit->is_new = work->made != NULL;
    warn(work);
    return judge_outside(work, error);
}

static ffd_status write_page(edit_work *work, ffd_error *error)
{
    const ffd_edit_desc *const desc = work->desc;
    const view_page_options options = {.full = desc->full,
                                       .color = FFD_VIEW_AUTO,
                                       .up = desc->up,
                                       .budget = &work->job.document->budget,
                                       .log = &work->job.log};
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_record(output, ffd_output_set_list(work->job.desc->output_set));
    ffd_output_redirect(output, desc->sink, desc->sink_user);
    ffd_status status;
    TRY_END(ffd_output_begin(output, desc->output, desc->force, error));
    status = ffd_view_page_write(&work->scene, &options, output, error);
    TRY_END(ffd_mapping_judge(work->job.losses, status, error));
    TRY_END(ffd_in_memory_judge(&work->job.desc->input, FFD_OK, error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}

static ffd_status run(edit_work *work, ffd_job_result *result, ffd_error *error)
{
    const double start = ffd_clock_seconds();
    TRY(make_scene(work, result, error));
    ffd_model_free(&work->model); /* writing needs memory of its own */
    const double made = ffd_clock_seconds();
    result->vertices = work->counts.inside + work->counts.outside;
    result->counts[FFD_VERTEX_INSIDE] = work->counts.inside;
    result->counts[FFD_VERTEX_OUTSIDE] = work->counts.outside;
    result->seconds.embed = made - start - result->seconds.read;
    TRY(write_page(work, error));
    result->seconds.write = ffd_clock_seconds() - made;
    result->picture = work->desc->output;
    return FFD_OK;
}

/* Runs a job whose data in memory have their names. */
static ffd_status edit(const ffd_edit_desc *desc, ffd_deform_desc *job, ffd_job_result *result,
                       ffd_error *error)
{
    edit_work work = {.desc = desc, .scene = {.animation = RIG_NONE}};
    ffd_lattice_source source;
    ffd_error own;
    ffd_status status = check_desc(desc, error);
    if (!status)
        status = make_lattice(&work, job, &source, error);
    if (status)
        return status;
    TRY_END(ffd_deform_job_begin(&work.job, job, true, result));
    status = run(&work, result, &own);
    if (status)
        result->error = own;
end:
    ffd_model_free(&work.model);
    ffd_free(work.faces);
    ffd_view_scene_free(&work.scene);
    status = ffd_deform_job_end(&work.job, status, result, error);
    ffd_lattice_destroy(&work.made);
    return status;
}

static ffd_status edit_in_time(const ffd_edit_desc *desc, ffd_deform_desc *job, ffd_job_result *result)
{
    job_memory memory = {0};
    deadline own;
    work_watch watch = ffd_job_watch(job);
    const deadline *const before = ffd_deadline_begin(&own, job->timeout, &watch);
    ffd_status status;
    job->sink = NULL;
    job->positions = NULL;
    if (job->input.memory == 0)
        job->input.memory = LEAST_VIEW_MEMORY;
    TRY_END(ffd_in_memory_output(desc->sink, desc->output, &result->error));
    TRY_END(ffd_in_memory_desc(&memory, job, &result->error));
    TRY_END(edit(desc, job, result, &result->error));
end:
    status = ffd_in_memory_end(&memory, status, &result->error);
    ffd_job_watch_end(&watch, status);
    ffd_deadline_end(before);
    return status;
}

ffd_status ffd_edit_run(const ffd_edit_desc *callers, ffd_job_result *callers_result, ffd_error *error)
{
    ffd_edit_desc desc;
    ffd_deform_desc job;
    ffd_job_result result;
    ffd_edit_desc_init(&desc, sizeof desc);
    ffd_deform_desc_init(&job, sizeof job);
    ffd_result_clear(&result);
    TRY(ffd_struct_check(sizeof result, callers_result, "ffd_job_result", error));
    ffd_status status;
    TRY_END(ffd_struct_take(&desc, sizeof desc, callers, "ffd_edit_desc", &result.error));
    TRY_END(desc.job ? ffd_deform_desc_take(desc.job, &job, &result.error)
                     : ffd_fail(&result.error, FFD_E_ARGUMENT, "the edit's description is not complete"));
    job.morph_results = NULL;
    desc.job = &job;
    TRY_END(edit_in_time(&desc, &job, &result));
end:
    if (status && error)
        *error = result.error;
    result.status = status;
    ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return status;
}
