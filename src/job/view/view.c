/* view.c - the job of `ffd view`: makes a scene of a mesh and its deformation, or of one or two files as they
   are. */
#include "job/view/view.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/struct_size.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "job/chain/chain_load.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/selection.h"
#include "job/input/settings.h"
#include "job/input/source.h"
#include "job/job_call.h"
#include "job/pass/chain_fit.h"
#include "job/report/output_set.h"
#include "job/report/report.h"
#include "job/view/view_run.h"
#include "view/page.h"
#include "view/view_picture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The state of a view. */
typedef struct view_work {
    const ffd_view_desc *desc;
    const view_frames *frames;
    deform_job job;
    job_details details;
    mesh_model model;
    uint64_t model_bytes; /* what the model takes of the document's budget */
    view_scene scene;
    uint32_t *faces;      /* of each triangle: its polygon */
    mesh_document *other; /* the deformed mesh file, kept open for its animations */
    view_morphs morphs;
} view_work;

void ffd_view_desc_init(ffd_view_desc *desc, size_t size)
{
    const ffd_view_desc defaults = {.struct_size = sizeof defaults, .color = FFD_VIEW_AUTO};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static bool is_page(const char *path)
{
    return ffd_path_has_ending(path, ".html") || ffd_path_has_ending(path, ".htm");
}

/* Whether there is a shape after: a deformation, or a second file. */
static bool has_after(const ffd_view_desc *desc)
{
    return desc->deformed || desc->job->lattice_count > 0;
}

static view_picture_options describe_picture(const view_work *work)
{
    const ffd_view_desc *const desc = work->desc;
    const bool has_poses = desc->animation && !is_page(desc->output);
    return (view_picture_options){.width = desc->width,
                                  .height = desc->height,
                                  .frames = has_poses && !desc->frames ? VIEW_POSES : desc->frames,
                                  .rows = has_poses ? has_after(desc) ? 2 : 1 : 0,
                                  .color = desc->color == FFD_VIEW_AUTO ? FFD_VIEW_DISPLACEMENT : desc->color,
                                  .camera = {desc->camera[0], desc->camera[1], desc->camera[2]},
                                  .up = desc->up,
                                  .threads = work->job.threads,
                                  .frame = work->frames->frame,
                                  .budget = work->job.document ? &work->job.document->budget : NULL,
                                  .log = &work->job.log};
}

static ffd_status check_desc(const view_work *work, ffd_error *error)
{
    const ffd_view_desc *const desc = work->desc;
    if (!desc->output || (desc->deformed && !desc->deformed->path))
        return ffd_fail(error, FFD_E_ARGUMENT, "the view's description is not complete");
    const view_picture_options picture = describe_picture(work);
    if ((int)desc->up < FFD_UP_Y || desc->up > FFD_UP_X)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of up", (int)desc->up);
    if ((int)desc->color < FFD_VIEW_DISPLACEMENT || desc->color > FFD_VIEW_AUTO)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of color", (int)desc->color);
    for (int a = 0; a < 3; a++)
        if (!isfinite(desc->camera[a]))
            return ffd_fail(error, FFD_E_ARGUMENT, "the camera's direction is not finite");
    if (!is_page(desc->output) && !ffd_path_has_ending(desc->output, ".png"))
        return ffd_fail_file(error, FFD_E_ARGUMENT, desc->output,
                             "the ending \"%s\" is not that of a page or a picture (.html .htm .png)",
                             ffd_path_ending(desc->output));
    TRY(ffd_view_picture_check(&picture, error));
    if (!desc->sink)
        TRY(ffd_view_check_inputs(desc, error));
    return desc->sink || work->frames->measured ? FFD_OK : ffd_output_check(desc->output, desc->force, error);
}

/* Whether the shapes without any morph target are shown. The job of --morph deforms these, but the mesh is
   shown with its default weights, as viewers show its output. */
static bool is_stored(const view_work *work)
{
    return work->job.stored && !work->desc->job->morphs;
}

/* What is shown of a mesh: the base, or what default weights of morph targets make of it. */
static mesh_state shown_state(const view_work *work, const mesh_document *document)
{
    return !is_stored(work) && ffd_mesh_shows_shapes(document) ? MESH_SHOWN : MESH_STORED;
}

/* Reads the mesh in the shape that is shown. */
static ffd_status read_model(view_work *work, ffd_error *error)
{
    mesh_document *const document = work->job.document;
    mesh_model *const model = &work->model;
    model->budget = &document->budget;
    model->wants_details = true;
    const uint64_t before = document->budget.taken;
    const ffd_status status = document->format->model(document, shown_state(work, document), model, error);
    work->model_bytes = document->budget.taken - before;
    if (status || !document->format->list_materials)
        return status;
    return document->format->list_materials(document, &work->job.log, &work->scene.materials, error);
}

/* Makes the report of this job alone, without times: the same job makes the same page. */
static ffd_status make_report(view_work *work, const ffd_job_result *result, ffd_error *error)
{
    byte_buffer text = {0};
    const report_entry entry = {.input = work->scene.name, .result = result, .stable = true};
    ffd_buffer_text(&text, "{\"format\": \"ffd-report\", \"version\": 1, \"jobs\": [");
    ffd_report_entry_text(&entry, &text);
    ffd_buffer_text(&text, "]}");
    work->scene.report = ffd_buffer_finish(&text);
    return work->scene.report ? FFD_OK : ffd_fail_memory(error);
}

/* Names of files without their folders: a page must not disclose those of its maker. */
static ffd_status name_scene(view_work *work, ffd_error *error)
{
    const ffd_source *const deformed = work->desc->deformed;
    work->scene.name = ffd_text_copy(ffd_path_name(ffd_source_name(&work->desc->job->input)));
    work->scene.output = deformed ? ffd_text_copy(ffd_path_name(ffd_source_name(deformed))) : NULL;
    return work->scene.name && (work->scene.output || !deformed) ? FFD_OK : ffd_fail_memory(error);
}

/* Makes the rigs before and after. They must live until the output is written. */
static ffd_status make_rigs(view_work *work, bool deformed, ffd_error *error)
{
    const ffd_view_desc *const desc = work->desc;
    const view_rigs_desc rigs = {.before = work->job.document,
                                 .after = work->other,
                                 .deformed = deformed,
                                 .follows = deformed && desc->job->rig == FFD_RIG_FOLLOW,
                                 .gradients = work->details.gradients,
                                 .shift = work->morphs.shift,
                                 .state = is_stored(work) ? MESH_STORED : MESH_SHOWN,
                                 .before_name = ffd_source_name(&desc->job->input),
                                 .after_name = desc->deformed ? ffd_source_name(desc->deformed) : NULL,
                                 .animation = desc->animation,
                                 .all = is_page(desc->output),
                                 .log = &work->job.log};
    return ffd_view_make_rigs(&rigs, &work->scene, error);
}

/* Adds the morph targets of a page. The rigs come first: they take results that these may replace. */
static ffd_status make_targets(view_work *work, bool deformed, ffd_error *error)
{
    const ffd_deform_desc *const job = work->desc->job;
    const view_targets_desc targets = {.before = work->job.document,
                                       .after = work->other,
                                       .job = &work->job,
                                       .deforms = deformed && !job->morphs && !job->as_morph,
                                       .stored = is_stored(work),
                                       .morph_names = job->morphs,
                                       .morph_count = work->morphs.count,
                                       .morphs = &work->morphs,
                                       .log = &work->job.log};
    return is_page(work->desc->output) ? ffd_view_add_targets(&targets, &work->scene, error) : FFD_OK;
}

/* Takes the job's figures into the scene, as marks and a report. */
static ffd_status take_findings(view_work *work, const ffd_job_result *result, ffd_error *error)
{
    deform_job *const job = &work->job;
    TRY(ffd_view_take_mesh(&work->model, &work->scene, &work->faces, &job->log, error));
    TRY(ffd_view_place_after(&work->model, job->desc->morphs ? work->morphs.after : work->details.deformed,
                             &work->scene, error));
    TRY(ffd_view_add_marks(job, result, &work->model, work->faces, &work->scene, error));
    TRY(ffd_view_add_splats(job->document, NULL, job->desc->morphs ? NULL : work->details.gradients,
                            &work->scene, error));
    if (!work->desc->no_cage)
        TRY(ffd_view_add_cages(&job->chain, work->desc->job->lattices, &work->scene, error));
    TRY(make_rigs(work, !job->desc->morphs, error));
    TRY(make_targets(work, true, error));
    return make_report(work, result, error);
}

/* Checks that an open mesh can be shown, and that the output is none of its files. */
static ffd_status check_mesh(const view_work *work, const ffd_source *source, mesh_document *document,
                             ffd_error *error)
{
    TRY(ffd_mesh_check(document, error));
    return work->desc->sink ? FFD_OK : ffd_view_check_files(source, document, work->desc->output, error);
}

/* Deforms the mesh in memory. A shape that a gate refuses is shown too; result then has the refusal. */
static ffd_status run_job(view_work *work, ffd_job_result *result, ffd_error *error)
{
    deform_job *const job = &work->job;
    job->stored = job->stored || job->desc->as_morph; /* it keeps the other targets */
    TRY(ffd_deform_job_open(job, JOB_NEEDS_NORMALS, result, error));
    TRY(check_mesh(work, &work->desc->job->input, job->document, error));
    TRY(read_model(work, error));
    /* Deform the shape with default weights, as for a conversion. */
    job->converts = !job->desc->morphs && shown_state(work, job->document) == MESH_SHOWN;
    job->details = &work->details;
    ffd_status status = job->desc->morphs ? ffd_view_run_morphs(job, &work->morphs, result, &result->error)
                                          : ffd_deform_job_run(job, result, &result->error);
    result->status = status;
    if (status == FFD_E_GATE)
        ffd_fail_name_file(&result->error, ffd_source_name(&work->desc->job->input));
    else if (status) {
        *error = result->error;
        return status;
    }
    return take_findings(work, result, error);
}

static ffd_status open_mesh(view_work *work, const ffd_source *source, mesh_document **document,
                            ffd_error *error)
{
    TRY(ffd_source_open(source, work->job.threads, document, error));
    const char *const name = source == work->desc->deformed ? ffd_source_name(source) : NULL;
    ffd_flaws_warn(&(*document)->flaws, name, &work->job.log);
    return check_mesh(work, source, *document, error);
}

/* Adds the lattices, fitted to the mesh at rest. */
static ffd_status load_cages(view_work *work, ffd_error *error)
{
    const ffd_deform_desc *const desc = work->desc->job;
    deform_job *const job = &work->job;
    const chain_outside outside = {0};
    if (desc->lattice_count == 0)
        return FFD_OK;
    TRY(ffd_deform_job_load_chain(job, 0, &outside, NULL, error));
    TRY(ffd_selection_apply(desc->only, desc->only_count, ffd_source_name(&desc->input), job->document,
                            error));
    TRY(ffd_chain_fit(&job->chain, job->document, job->threads, NULL, error));
    return work->desc->no_cage ? FFD_OK
                               : ffd_view_add_cages(&job->chain, desc->lattices, &work->scene, error);
}

/* Sets the positions after to those of the deformed mesh file. */
static ffd_status read_deformed(view_work *work, ffd_error *error)
{
    const ffd_source *const deformed = work->desc->deformed;
    const uint64_t count = ffd_mesh_vertex_count(work->job.document);
    double *positions = NULL;
    TRY(open_mesh(work, deformed, &work->other, error));
    ffd_status status = FFD_OK;
    if (ffd_mesh_vertex_count(work->other) != count)
        TRY_END(ffd_fail_file(error, FFD_E_INVALID, ffd_source_name(deformed),
                              "has %llu vertices, and %s has %llu: they are not one mesh before and after",
                              (unsigned long long)ffd_mesh_vertex_count(work->other),
                              ffd_source_name(&work->desc->job->input), (unsigned long long)count));
    TRY_END(ffd_view_read_positions(work->other, shown_state(work, work->other), &positions, error));
    TRY_END(ffd_view_match_parts(work->job.document, work->other, &work->scene.rigs[1].order, error));
    TRY_END(ffd_view_place_after(&work->model, positions, &work->scene, error));
end:
    ffd_free(positions);
    return status;
}

/* Shows files as they are: one, or one before and another after. */
static ffd_status read_files(view_work *work, ffd_error *error)
{
    TRY(open_mesh(work, &work->desc->job->input, &work->job.document, error));
    TRY(read_model(work, error));
    TRY(ffd_view_take_mesh(&work->model, &work->scene, &work->faces, &work->job.log, error));
    TRY(work->desc->deformed ? read_deformed(work, error)
                             : ffd_view_place_after(&work->model, NULL, &work->scene, error));
    TRY(ffd_view_add_splats(work->job.document, work->other, NULL, &work->scene, error));
    TRY(load_cages(work, error));
    TRY(make_rigs(work, false, error));
    return make_targets(work, false, error);
}

static ffd_status write_page(const view_work *work, file_output *output, ffd_error *error)
{
    const ffd_view_desc *const desc = work->desc;
    const view_page_options options = {.full = desc->full,
                                       .color = desc->color,
                                       .camera = {desc->camera[0], desc->camera[1], desc->camera[2]},
                                       .up = desc->up,
                                       .budget = work->job.document ? &work->job.document->budget : NULL,
                                       .log = &work->job.log};
    return ffd_view_page_write(&work->scene, &options, output, error);
}

static ffd_status write_picture(const view_work *work, file_output *output, ffd_error *error)
{
    const view_picture_options options = describe_picture(work);
    return ffd_view_picture_write(&work->scene, &options, output, error);
}

/* The frame is all that is wanted. */
static ffd_status measure_view(const view_work *work, ffd_error *error)
{
    const view_picture_options options = describe_picture(work);
    return ffd_mapping_judge(work->job.losses,
                             ffd_view_picture_measure(&work->scene, &options, work->frames->measured, error),
                             error);
}

static ffd_status write_view(view_work *work, ffd_error *error)
{
    const ffd_view_desc *const desc = work->desc;
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_record(output, ffd_output_set_list(desc->job->output_set));
    ffd_output_redirect(output, desc->sink, desc->sink_user);
    ffd_status status;
    TRY_END(ffd_output_begin(output, desc->output, desc->force, error));
    status = is_page(desc->output) ? write_page(work, output, error) : write_picture(work, output, error);
    TRY_END(ffd_mapping_judge(work->job.losses, status, error));
    /* an image that seems to be missing may have failed to load */
    TRY_END(ffd_in_memory_judge(&desc->job->input, FFD_OK, error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}

/* Frees what the scene was made from. */
static void free_sources(view_work *work)
{
    ffd_details_free(&work->details);
    ffd_view_free_morphs(&work->morphs);
    ffd_model_free(&work->model);
    ffd_free(work->faces);
    work->faces = NULL;
}

/* Warns that files as they are have no statuses and no det F. */
static void judge_color(const view_work *work)
{
    const ffd_view_color color = work->desc->color;
    if (!work->scene.statuses && (color == FFD_VIEW_STATUS || color == FFD_VIEW_DET))
        ffd_log_line(&work->job.log, FFD_LOG_WARNING,
                     "coloured by displacement: without a deformation there is no %s",
                     color == FFD_VIEW_DET ? "det F" : "status");
}

/* Names the settings of a deformation, which do nothing where files are shown as they are. */
static void warn_of_unused(const view_work *work)
{
    const ffd_deform_desc *const job = work->desc->job;
    static const char *const settings[] = {"set",      "outside", "snap", "blocks", "normals", "rig",
                                           "as_morph", "weight",  "seam", "rigid",  "uniform"};
    char names[300] = "";
    const size_t first = job->lattice_count > 0 ? 1 : 0; /* the cages of lattices are shown by set */
    for (size_t i = first; i < sizeof settings / sizeof *settings; i++)
        if (ffd_setting_is_set(job, settings[i])) {
            const size_t length = strlen(names);
            char name[40];
            snprintf(name, sizeof name, "{%s}", settings[i]);
            snprintf(names + length, sizeof names - length, "%s%s", length ? ", " : "", SPELLED(name));
        }
    if (*names)
        ffd_log_line(
            &work->job.log, FFD_LOG_WARNING,
            "not used, since files are shown as they are: %s (a deformation needs {lattices}, and no "
            "{deformed})",
            names);
}

static ffd_status make_view(view_work *work, ffd_job_result *result, ffd_error *error)
{
    const bool deforms = !work->desc->deformed && work->desc->job->lattice_count > 0;
    TRY(check_desc(work, error));
    TRY(name_scene(work, error));
    TRY(deforms ? run_job(work, result, error) : read_files(work, error));
    if (work->model.nodes_left)
        ffd_log_line(&work->job.log, FFD_LOG_WARNING, "not shown: the GPU instances of %zu %s",
                     work->model.nodes_left, ffd_plural(work->model.nodes_left, "node", "nodes"));
    judge_color(work);
    if (!deforms)
        warn_of_unused(work);
    ffd_view_measure(&work->scene);
    free_sources(work); /* drawing needs memory of its own */
    if (work->job.document)
        work->job.document->budget.taken -= work->model_bytes;
    return work->frames->measured ? measure_view(work, error) : write_view(work, error);
}

static void free_work(view_work *work)
{
    free_sources(work);
    ffd_view_scene_free(&work->scene); /* its skeletons refer to open documents */
    ffd_source_close(&work->other);
}

static ffd_status view(const ffd_view_desc *desc, const view_frames *frames, ffd_job_result *result,
                       ffd_error *error)
{
    view_work work = {.desc = desc, .frames = frames, .scene = {.animation = RIG_NONE}};
    ffd_error own;
    ffd_output_list *const outputs = desc->job->output_list;
    if (outputs)
        ffd_paths_free(&outputs->names);
    ffd_status status;
    TRY_END(ffd_deform_job_begin(&work.job, desc->job, true, result));
    result->outputs = outputs;
    work.job.stored = desc->as_stored;
    status = make_view(&work, result, &own);
    if (!status && outputs && !frames->measured && !ffd_output_is_stream(desc->output))
        status = ffd_paths_add(&outputs->names, desc->output, &own);
    if (status) {
        result->error = own;
    } else {
        result->picture = frames->measured ? NULL : desc->output;
        status = result->status; /* of the gates */
    }
end:
    free_work(&work);
    return ffd_deform_job_end(&work.job, status, result, error);
}

static void allow_memory(ffd_source *source)
{
    if (source->memory == 0)
        source->memory = LEAST_VIEW_MEMORY;
}

/* Names and checks data in memory. deformed: receives the library's own copy of desc->deformed. The job's own
   output is ignored. */
static ffd_status take_memory(job_memory *memory, ffd_view_desc *desc, ffd_source *deformed,
                              ffd_deform_desc *job, ffd_error *error)
{
    job->sink = NULL;
    job->positions = NULL;
    allow_memory(&job->input);
    if (desc->deformed) {
        *deformed = *desc->deformed;
        allow_memory(deformed);
        desc->deformed = deformed;
        TRY(ffd_in_memory_source(memory, deformed, error));
    }
    TRY(ffd_in_memory_output(desc->sink, desc->output, error));
    return ffd_in_memory_desc(memory, job, error);
}

static ffd_status view_in_time(ffd_view_desc *desc, const view_frames *frames, ffd_deform_desc *job,
                               ffd_job_result *result)
{
    ffd_source deformed;
    job_memory memory = {0};
    deadline own;
    work_watch watch = ffd_job_watch(job);
    const deadline *const before = ffd_deadline_begin(&own, job->timeout, &watch);
    ffd_status status;
    TRY_END(take_memory(&memory, desc, &deformed, job, &result->error));
    TRY_END(view(desc, frames, result, &result->error));
end:
    status = ffd_in_memory_end(&memory, status, &result->error);
    ffd_job_watch_end(&watch, status);
    ffd_deadline_end(before);
    return status;
}

ffd_status ffd_view_run_framed(const ffd_view_desc *callers, const view_frames *frames,
                               ffd_job_result *callers_result, ffd_error *error)
{
    ffd_view_desc desc;
    ffd_deform_desc job;
    ffd_job_result result;
    ffd_view_desc_init(&desc, sizeof desc);
    ffd_deform_desc_init(&job, sizeof job); /* stays unused for files as they are */
    ffd_result_clear(&result);
    TRY(ffd_struct_check(sizeof result, callers_result, "ffd_job_result", error));
    ffd_status status;
    TRY_END(ffd_struct_take(&desc, sizeof desc, callers, "ffd_view_desc", &result.error));
    if (desc.job)
        TRY_END(ffd_deform_desc_take(desc.job, &job, &result.error));
    job.morph_results = NULL; /* only jobs that write fill these */
    desc.job = &job;
    TRY_END(view_in_time(&desc, frames, &job, &result));
end:
    if (status && error)
        *error = result.error;
    result.status = status;
    ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return status;
}

ffd_status ffd_view_run(const ffd_view_desc *desc, ffd_job_result *result, ffd_error *error)
{
    return ffd_view_run_framed(desc, &(view_frames){0}, result, error);
}
