/* deform.c - the job of `ffd deform`. */
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "io/format_names.h"
#include "io/formats.h"
#include "job/chain/job_cache.h"
#include "job/conversion.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"
#include "job/job_call.h"
#include "job/morphs.h"
#include "job/reads.h"
#include "job/report/depfile.h"
#include "job/report/output_set.h"
#include "job/sharing.h"
#include "lattice/file/lattice_source.h"
#include "mesh/morphs.h"
#include "mesh/resource/copy_notes.h"
#include "mesh/resource/sidecar.h"
#include <string.h>

/* Restores files that a killed run had set aside, before they are read. */
static ffd_status restore_output(const ffd_deform_desc *desc, ffd_error *error)
{
    const char *const path = desc->in_place ? desc->input.path : desc->output;
    return path && !ffd_output_is_stream(path) && !desc->sink ? ffd_restore_output(path, error) : FFD_OK;
}

/* Refuses options that need an output file. */
static ffd_status check_no_output(const ffd_deform_desc *desc, ffd_error *error)
{
    const char *const what = desc->as_morph                           ? "{as_morph}"
                             : desc->depfile                          ? "{depfile}"
                             : desc->output_format != FFD_FORMAT_AUTO ? "{output_format}"
                                                                      : NULL;
    return what ? ffd_fail(error, FFD_E_ARGUMENT, "%s needs an output: only positions are asked for",
                           SPELLED(what))
                : FFD_OK;
}

/* Refuses an output that the job reads. Most outputs do not exist, which one question answers. */
static ffd_status refuse_inputs(const ffd_deform_desc *desc, ffd_error *error)
{
    if (ffd_output_is_stream(desc->output) || !ffd_file_exists(desc->output))
        return FFD_OK;
    if (ffd_job_reads_mesh(&desc->input, desc->output))
        return ffd_fail_file(error, FFD_E_EXISTS, desc->output, "is the input ({in_place} overwrites it)");
    if (ffd_job_reads_lattice(desc->lattices, desc->lattice_count, desc->output))
        return ffd_fail_file(error, FFD_E_EXISTS, desc->output, "is a lattice of this command");
    if (ffd_job_reads_weights(desc, desc->output))
        return ffd_fail_file(error, FFD_E_EXISTS, desc->output, "is the file of the weights ({weight})");
    return ffd_job_reads_embedding(desc, desc->output)
               ? ffd_fail_file(error, FFD_E_EXISTS, desc->output, "is the embedding that is to be reused")
               : FFD_OK;
}

/* Determines the output's path and format, and whether it may replace a file. */
static ffd_status resolve_output(const ffd_deform_desc *desc, mesh_save_options *options, ffd_error *error)
{
    const char *input = desc->input.path;
    *options = (mesh_save_options){.path = desc->output,
                                   .to_sink = desc->sink,
                                   .from_memory = desc->input.bytes.data,
                                   .format = desc->output_format,
                                   .force = desc->force || desc->if_changed,
                                   .resources = desc->resources,
                                   .sparse_targets = desc->morphs,
                                   .input = input};
    if (!ffd_deform_desc_writes(desc)) {
        TRY(check_no_output(desc, error));
        return ffd_source_format(&desc->input, &options->format, error);
    }
    if (desc->depfile && desc->output && ffd_output_is_stream(desc->output))
        return ffd_fail(error, FFD_E_ARGUMENT, "{depfile} needs a file name as {output}");
    if (desc->in_place) {
        if (ffd_file_is_stream(input))
            return ffd_fail(error, FFD_E_ARGUMENT, "standard input cannot be overwritten in place");
        options->path = input;
        options->force = true;
        return ffd_source_format(&desc->input, &options->format, error);
    }
    if (!desc->output)
        return ffd_fail(error, FFD_E_ARGUMENT, "no output is given");
    if (options->format == FFD_FORMAT_AUTO)
        options->format = ffd_format_from_name(desc->output);
    if (options->format == FFD_FORMAT_AUTO && ffd_output_is_stream(desc->output))
        return ffd_fail(error, FFD_E_ARGUMENT, "standard output needs {output_format} " FFD_FORMAT_NAMES);
    if (options->format == FFD_FORMAT_AUTO)
        return ffd_format_refuse_name(desc->output, error);
    if (desc->sink)
        return FFD_OK;
    if (!ffd_output_is_stream(desc->output))
        TRY(ffd_format_check_output(options->format, desc->output, error));
    TRY(refuse_inputs(desc, error));
    return desc->make_folders ? ffd_output_check_with_folder(desc->output, options->force, error)
                              : ffd_output_check(desc->output, options->force, error);
}

/* Makes the folder of the output where the caller wants that. */
static ffd_status make_folder(const ffd_deform_desc *desc, file_output *output, ffd_error *error)
{
    if (!desc->make_folders || !desc->output || ffd_output_is_stream(desc->output))
        return FFD_OK;
    char *const folder = ffd_path_folder(desc->output);
    const ffd_status status = folder ? ffd_output_folder(output, folder, error) : ffd_fail_memory(error);
    ffd_free(folder);
    return status;
}

static ffd_status write_mesh(deform_job *job, const mesh_save_options *options, file_output *output,
                             ffd_error *error)
{
    const conversion_morph morph = {job->desc->as_morph, &job->base};
    const bool morphs = job->desc->as_morph || job->desc->morphs;
    if (!ffd_conversion_needed(job->document, options->format))
        return job->document->format->save(job->document, options, output, &job->log, error);
    return ffd_conversion_save(job->document, ffd_job_written(job), morphs ? &morph : NULL, options, output,
                               &job->log, error);
}

static void warn_of_name(const deform_job *job, const char *name)
{
    if (ffd_depfile_troubles(name))
        ffd_log_line(&job->log, FFD_LOG_WARNING,
                     "the depfile names \"%s\": make or ninja cannot read such a name", name);
}

/* Adds the paths that `to` does not have yet. */
static ffd_status add_paths(path_list *to, const path_list *from, ffd_error *error)
{
    const size_t before = to->count;
    for (size_t i = 0; i < from->count; i++) {
        size_t k = 0;
        while (k < before && strcmp(to->paths[k], from->paths[i]) != 0)
            k++;
        if (k == before)
            TRY(ffd_paths_add(to, from->paths[i], error));
    }
    return FFD_OK;
}

/* Whether a lattice takes the cached box. */
static bool goes_round_all(const deform_job *job)
{
    for (size_t i = 0; i < job->chain.count; i++) {
        const ffd_lattice *const lattice = job->chain.links[i].lattice;
        if (ffd_lattice_needs_bounds(lattice) && ffd_lattice_get_mesh_count(lattice) == 0)
            return true;
    }
    return false;
}

/* Makes the depfile rule of the outputs. inputs: the files of the mesh; the other inputs are added. */
static ffd_status make_rule(const deform_job *job, const path_list *outputs, path_list *inputs,
                            byte_buffer *rule, ffd_error *error)
{
    const ffd_deform_desc *desc = job->desc;
    for (size_t i = 0; i < desc->lattice_count; i++) {
        const char *const path = ffd_lattice_file(&desc->lattices[i]);
        const bool is_again = path && i > 0 && desc->lattices[i - 1].path == desc->lattices[i].path;
        TRY(path && !is_again ? ffd_paths_add(inputs, path, error) : FFD_OK);
    }
    const char *const embedding = desc->embedding.bytes.data ? NULL : desc->embedding.path;
    if (embedding && !ffd_file_is_stream(embedding))
        TRY(ffd_paths_add(inputs, embedding, error));
    if (ffd_job_weight_file(desc))
        TRY(ffd_paths_add(inputs, ffd_job_weight_file(desc), error));
    for (size_t i = 0; i < job->chain.count; i++)
        TRY(add_paths(inputs, &job->chain.links[i].box_files, error));
    if (desc->shared_box && goes_round_all(job))
        TRY(add_paths(inputs, &desc->shared_box->files, error));
    TRY(ffd_depfile_rule(outputs, inputs, rule, error));
    for (size_t i = 0; i < outputs->count; i++)
        warn_of_name(job, outputs->paths[i]);
    for (size_t i = 0; i < inputs->count; i++)
        warn_of_name(job, inputs->paths[i]);
    return FFD_OK;
}

/* Writes the mesh and, if a depfile is wanted, makes its rule. */
static ffd_status write_all(deform_job *job, const mesh_save_options *options, file_output *output,
                            byte_buffer *rule, ffd_error *error)
{
    if (!job->desc->depfile)
        return write_mesh(job, options, output, error);
    path_list inputs = {0};
    mesh_save_options listing = *options;
    listing.copied = &inputs;
    ffd_status status;
    TRY_END(ffd_source_files(&job->desc->input, job->document, &inputs, error));
    TRY_END(write_mesh(job, &listing, output, error));
    TRY_END(make_rule(job, options->outputs, &inputs, rule, error));
end:
    ffd_paths_free(&inputs);
    return status;
}

/* Whether the cache wants a hash of this output. A conversion is not hashed: it may refer to files under
   other names. */
static bool is_hashed(const deform_job *job)
{
    return ffd_job_cache_hashes_output(job->desc->cache) && !job->converts &&
           ffd_source_is_alone(job->document);
}

/* Returns where the run keeps notes of copies. */
static const copy_notes *notes_of(const ffd_deform_desc *desc)
{
    return desc->output_set && desc->output_set->notes ? desc->output_set->notes : &ffd_copy_notes_of_user;
}

static ffd_status save(deform_job *job, const mesh_save_options *options, ffd_error *error)
{
    const bool hashed = is_hashed(job);
    bool is_offered = false;
    hash128 hash;
    byte_buffer rule = {0};
    file_output *output;
    noted_copies noted = {.notes = notes_of(job->desc)};
    mesh_save_options noting = *options;
    noting.noted = job->desc->sink ? NULL : &noted;
    TRY(ffd_output_create(&output, error));
    ffd_output_record(output, ffd_output_set_list(job->desc->output_set));
    ffd_output_redirect(output, job->desc->sink, job->desc->sink_user);
    if (job->desc->if_changed)
        ffd_output_keep_equal(output);
    if (hashed)
        ffd_output_hash(output);
    ffd_status status;
    TRY_END(make_folder(job->desc, output, error));
    TRY_END(ffd_mapping_judge(job->losses, write_all(job, &noting, output, &rule, error), error));
    /* a missing resource may be the fault of a resolve callback */
    TRY_END(ffd_in_memory_judge(&job->desc->input, FFD_OK, error));
    TRY_END(ffd_deadline_check(error));
    /* Before the mesh is in place: a disk too full for the rule leaves the old one. */
    is_offered = job->desc->depfile;
    if (is_offered)
        TRY_END(ffd_depfile_offer(job->desc->depfile, &rule, error));
    TRY_END(ffd_output_commit(output, error));
    ffd_copies_keep(&noted);
    if (hashed && ffd_output_hash_value(output, &hash))
        ffd_job_cache_put_output(job->desc->cache, &hash);
end:
    if (status && is_offered)
        ffd_depfile_withdraw(job->desc->depfile, &rule);
    ffd_buffer_free(&rule);
    ffd_copies_free(&noted);
    ffd_output_destroy(&output);
    return status;
}

/* Refuses a conversion whose other files cannot be written. */
static ffd_status dry_run_conversion(deform_job *job, const mesh_save_options *options, ffd_error *error)
{
    const mesh_format *const to = ffd_format_table(options->format);
    sidecar_names names = {.options = options, .log = &job->log};
    ffd_format from;
    if (!to->sidecars || !to->sidecars->count || ffd_output_is_stream(options->path) || options->to_sink)
        return FFD_OK;
    TRY(ffd_source_format(&job->desc->input, &from, error));
    const size_t count = to->sidecars->count(NULL, from, options->format);
    for (size_t i = 0; i < count; i++) {
        char *path;
        TRY(ffd_sidecar_next(&names, NULL, NULL, &path, error));
        ffd_status status = ffd_output_check_with_folder(path, options->force, error);
        if (!status && ffd_mesh_vertex_count(job->document) > 0) /* else the buffer is empty: no file */
            status = ffd_paths_add(options->outputs, path, error);
        ffd_free(path);
        TRY(status);
    }
    return FFD_OK;
}

/* Refuses an output whose other files cannot be written, as writing would. */
static ffd_status dry_run_job(deform_job *job, const mesh_save_options *options, ffd_error *error)
{
    noted_copies noted = {.notes = notes_of(job->desc)};
    mesh_save_options noting = *options;
    noting.noted = job->desc->sink ? NULL : &noted;
    if (ffd_conversion_needed(job->document, options->format))
        return dry_run_conversion(job, options, error);
    const ffd_status status = job->document->format->save(job->document, &noting, NULL, &job->log, error);
    ffd_copies_free(&noted);
    return status;
}

static const char *name_of_format(ffd_format format)
{
    return format == FFD_FORMAT_GLB ? "GLB" : ffd_format_table(format)->name;
}

/* Programs go by the ending. */
static void warn_of_ending(const deform_job *job, const mesh_save_options *options)
{
    const ffd_format ending = ffd_format_from_name(options->path);
    if (ending != FFD_FORMAT_AUTO && ending != options->format)
        ffd_log_line(&job->log, FFD_LOG_WARNING, "%s is written as %s, although its ending says %s",
                     ffd_file_display_name(options->path), name_of_format(options->format),
                     name_of_format(ending));
}

static ffd_status check_morph(const deform_job *job, const mesh_save_options *options, ffd_error *error)
{
    const bool morphs = options->format == FFD_FORMAT_GLTF || options->format == FFD_FORMAT_GLB;
    if ((!job->desc->as_morph && !job->desc->morphs) || morphs)
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_ARGUMENT, options->path,
                         "cannot hold a morph target: only .gltf and .glb can (%s)",
                         job->desc->morphs ? SPELLED("{morphs}") : SPELLED("{as_morph}"));
}

static ffd_status check_rig(const deform_job *job, const mesh_save_options *options, ffd_error *error)
{
    if (job->desc->rig == FFD_RIG_KEEP || !ffd_conversion_needed(job->document, options->format))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_ARGUMENT, options->path,
                         "cannot hold nodes that follow: only .gltf and .glb can ({rig=follow})");
}

/* If a morph target is wanted, keeps the base shape. */
static ffd_status begin_morph(deform_job *job, ffd_error *error)
{
    const mesh_format *format = job->document->format;
    if (!job->desc->as_morph)
        return FFD_OK;
    if (!format->morphs) { /* a conversion */
        job->base.budget = &job->document->budget;
        return format->model(job->document, MESH_STORED, &job->base, error);
    }
    return format->morphs->keep_base(job->document, job->desc->as_morph, error);
}

/* Whether no option needs normals. */
static bool needs_only_positions(const ffd_deform_desc *desc, const mesh_save_options *options)
{
    ffd_format input;
    return desc->normals == FFD_NORMALS_KEEP && !desc->quality && desc->only_count == 0 &&
           ffd_source_format(&desc->input, &input, NULL) == FFD_OK && input == options->format;
}

/* Refuses to replace what the job reads through its mesh and its lattices. */
static ffd_status check_reads(const deform_job *job, const char *output, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    if (!ffd_deform_desc_writes(desc) || desc->in_place || desc->sink)
        return FFD_OK;
    TRY(ffd_job_check_mesh_files(output, &desc->input, job->document, error));
    return ffd_job_check_box_files(output, &job->chain, desc->lattices, error);
}

/* Gives the names of the outputs to the caller. */
static void hand_over(const ffd_deform_desc *desc, path_list *outputs)
{
    if (!desc->output_list)
        return;
    ffd_paths_free(&desc->output_list->names);
    desc->output_list->names = *outputs;
    *outputs = (path_list){0};
}

/* Saves the result, or only looks whether that would be refused, and lists the outputs. */
static ffd_status write_outputs(deform_job *job, mesh_save_options *options, bool writes, ffd_error *error)
{
    path_list outputs = {0};
    job_sharing sharing;
    ffd_status status;
    ffd_sharing_begin(&sharing, job->desc, job->document, options->path, options->format, &options->sharing);
    options->outputs = &outputs;
    if (!ffd_output_is_stream(options->path))
        TRY_END(ffd_paths_add(&outputs, options->path, error));
    TRY_END(writes ? save(job, options, error) : dry_run_job(job, options, error));
    hand_over(job->desc, &outputs);
end:
    ffd_sharing_end(&sharing);
    options->outputs = NULL;
    ffd_paths_free(&outputs);
    return status;
}

/* Saves the result; a dry run only looks whether that would be refused. */
static ffd_status write_output(deform_job *job, mesh_save_options *options, ffd_job_result *result,
                               ffd_error *error)
{
    const double start = ffd_clock_seconds();
    const bool writes = !job->desc->dry_run;
    options->indices_left = &result->indices_left;
    options->bytes_left = &result->bytes_left;
    options->bounds_left = &result->bounds_left;
    const ffd_status status = write_outputs(job, options, writes, error);
    if (writes)
        result->seconds.write = ffd_clock_seconds() - start;
    return status;
}

static ffd_status plan_animation(deform_job *job, mesh_save_options *options, ffd_error *error)
{
    if (!job->animation)
        return FFD_OK;
    TRY(job->animation->plan(job->animation, error));
    options->sparse_targets = job->desc->morphs;
    options->animated = &job->animation->figures;
    return FFD_OK;
}

static ffd_status deform_and_save(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    mesh_save_options options;
    TRY(restore_output(job->desc, error));
    TRY(resolve_output(job->desc, &options, error));
    TRY(plan_animation(job, &options, error));
    TRY(check_morph(job, &options, error));
    TRY(ffd_morphs_begin(job, error));
    const unsigned needs = needs_only_positions(job->desc, &options) ? 0 : JOB_NEEDS_NORMALS;
    TRY(ffd_deform_job_open(job, needs, result, error));
    TRY(check_reads(job, options.path, error));
    TRY(check_rig(job, &options, error));
    TRY(ffd_conversion_check(job->document, options.format, error));
    TRY(begin_morph(job, error));
    job->converts = ffd_conversion_needed(job->document, options.format);
    TRY(job->desc->morphs ? ffd_morphs_run(job, result, error) : ffd_deform_job_run(job, result, error));
    if (!ffd_deform_desc_writes(job->desc))
        return FFD_OK;
    warn_of_ending(job, &options);
    return write_output(job, &options, result, error);
}

/* Several morph targets share the locations of the vertices through a cache of the job's own. */
static ffd_status cache_locations(ffd_deform_desc *desc, bool animates, ffd_job_cache **cache,
                                  ffd_error *error)
{
    *cache = NULL;
    if ((!desc->morphs && !animates) || ffd_job_cache_holds_meshes(desc->cache))
        return FFD_OK;
    TRY(ffd_job_cache_create(cache, error));
    desc->cache = *cache;
    return FFD_OK;
}

static ffd_status run(const ffd_deform_desc *desc, job_animation *animation, ffd_job_result *result)
{
    deform_job job;
    ffd_status status;
    TRY_END(ffd_deform_job_begin(&job, desc, false, result));
    job.animation = animation;
    TRY_END(deform_and_save(&job, result, &result->error));
end:
    ffd_morphs_end(&job);
    return ffd_deform_job_end(&job, status, result, NULL);
}

ffd_status ffd_deform_call(job_call *call, job_animation *animation)
{
    ffd_job_cache *cache = NULL;
    ffd_status status;
    TRY_END(cache_locations(&call->desc, animation, &cache, &call->result.error));
    TRY_END(run(&call->desc, animation, &call->result));
end:
    ffd_job_cache_destroy(&cache);
    return status;
}

ffd_status ffd_deform_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    job_call call;
    ffd_status status;
    TRY_END(ffd_job_call_begin(&call, desc, result, error));
    if (!ffd_deform_desc_writes(&call.desc)) /* normals are not written */
        call.desc.normals = FFD_NORMALS_KEEP;
    TRY_END(ffd_deform_call(&call, NULL));
end:
    return ffd_job_call_end(&call, status, error);
}

/* Opens the mesh and lists what would be written. */
static ffd_status list_outputs(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    mesh_save_options options;
    TRY(resolve_output(job->desc, &options, error));
    TRY(ffd_deform_job_open(job, 0, result, error));
    return write_outputs(job, &options, false, error);
}

ffd_status ffd_deform_list_outputs(const ffd_deform_desc *desc, ffd_error *error)
{
    deform_job job;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc own = *desc;
    own.log = NULL;
    own.force = true; /* they may be there */
    if (!ffd_deform_desc_writes(&own))
        return FFD_OK;
    ffd_status status;
    TRY_END(ffd_deform_job_begin(&job, &own, false, &result));
    TRY_END(list_outputs(&job, &result, &result.error));
end:
    return ffd_deform_job_end(&job, status, &result, error);
}
