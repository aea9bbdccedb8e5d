#include "job/morphs.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/chain/chain_load.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "mesh/morphs.h"
#include "json/json_chars.h"
#include <stdio.h>
#include <string.h>

/* Memory for the result of one vertex in one target, in bytes. */
#define TARGET_BYTES 64

static ffd_status check_name(const char *name, ffd_error *error)
{
    char shown[80];
    if (name && *name && ffd_utf8_is_valid(name, strlen(name)))
        return FFD_OK;
    ffd_name_shown(name ? name : "", shown, sizeof shown);
    return ffd_fail(error, FFD_E_ARGUMENT, "{morphs}: \"%s\" is not the name of a morph target in UTF-8",
                    shown);
}

static ffd_status check_names(const ffd_deform_desc *desc, ffd_error *error)
{
    intern_table names = {0};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < desc->lattice_count; i++) {
        uint32_t index;
        char shown[80];
        TRY_END(check_name(desc->morphs[i], error));
        if (!ffd_intern(&names, desc->morphs[i], strlen(desc->morphs[i]), &index))
            TRY_END(ffd_fail_memory(error));
        if (index == i)
            continue;
        ffd_name_shown(desc->morphs[i], shown, sizeof shown);
        TRY_END(ffd_fail(error, FFD_E_ARGUMENT, "{morphs}: two morph targets are called \"%s\"", shown));
    }
end:
    ffd_intern_free(&names);
    return status;
}

/* Takes the content of a clip that was made for the job. */
static ffd_status take_clip(deform_job *job, morph_clip *clip, ffd_error *error)
{
    job->clips = ffd_alloc(1, sizeof *job->clips);
    if (!job->clips)
        return ffd_fail_memory(error);
    job->clip_count = 1;
    job->clips[0] = *clip;
    *clip = (morph_clip){0};
    return FFD_OK;
}

ffd_status ffd_morphs_begin(deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    TRY(desc->morphs ? check_names(desc, error) : FFD_OK);
    if (job->animation && job->animation->clip)
        return take_clip(job, job->animation->clip, error);
    if (desc->clip_count == 0)
        return FFD_OK;
    job->clips = ffd_alloc_zero(desc->clip_count, sizeof *job->clips);
    if (!job->clips)
        return ffd_fail_memory(error);
    job->clip_count = desc->clip_count;
    for (size_t c = 0; c < desc->clip_count; c++)
        TRY(ffd_morph_clip_parse(desc->clips[c], &job->clips[c], error));
    return FFD_OK;
}

void ffd_morphs_end(deform_job *job)
{
    for (size_t c = 0; c < job->clip_count; c++)
        ffd_morph_clip_free(&job->clips[c]);
    ffd_free(job->clips);
    job->clips = NULL;
    job->clip_count = 0;
}

/* Passes the clips to the writer. In a conversion only the new targets exist. */
static ffd_status keep_clips(const deform_job *job, ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    intern_table names = {0};
    uint32_t index;
    bool listed = true;
    if (!job->converts && job->document->format->morphs)
        return job->document->format->morphs->keep_clips(job->document, job->clips, job->clip_count,
                                                         desc->morphs, desc->lattice_count, error);
    for (size_t i = 0; i < desc->lattice_count && listed; i++)
        listed = ffd_intern(&names, desc->morphs[i], strlen(desc->morphs[i]), &index);
    const ffd_status status =
        listed ? ffd_morph_clips_check(job->clips, job->clip_count, &names, error) : ffd_fail_memory(error);
    ffd_intern_free(&names);
    return status;
}

/* Starts a conversion with the base shape. */
static ffd_status begin(deform_job *job, ffd_error *error)
{
    if (!job->converts)
        return FFD_OK;
    job->base.budget = &job->document->budget;
    const ffd_status status = job->document->format->model(job->document, MESH_STORED, &job->base, error);
    job->base.drops_still = job->animation;
    job->base.clips = job->clips;
    job->base.clip_count = job->clip_count;
    return status;
}

static ffd_status keep_base(void *context, deform_job *job, size_t target, ffd_error *error)
{
    (void)context;
    (void)target;
    return job->converts
               ? FFD_OK
               : job->document->format->morphs->keep_base(job->document, job->desc->as_morph, error);
}

/* Conversion: adds the deformed shape to the model as a morph target. */
static ffd_status keep_shape(void *context, deform_job *job, size_t target, ffd_error *error)
{
    (void)context;
    (void)target;
    if (!job->converts)
        return FFD_OK;
    mesh_model after = {.budget = &job->document->budget};
    ffd_status status;
    TRY_END(job->document->format->model(job->document, ffd_job_written(job), &after, error));
    TRY_END(ffd_model_add_morph(&job->base, &after, job->desc->as_morph, error));
end:
    ffd_model_free(&after);
    return status;
}

/* Adds the target's name to the message of a failure. */
static void name_target(const char *name, size_t count, ffd_error *error)
{
    char shown[80], message[sizeof error->message];
    if (count < 2 || error->status == FFD_E_MEMORY)
        return;
    ffd_name_shown(name, shown, sizeof shown);
    snprintf(message, sizeof message, "morph target \"%s\": %.400s", shown, error->message);
    memcpy(error->message, message, sizeof message);
}

/* A log of one target of an animation: what was said of an earlier one, as of vertices that are outside, is
   true of all. */
typedef struct said_log {
    mesh_log log;
    intern_table *said;
} said_log;

static void say_once(void *user, ffd_log_level level, const char *line)
{
    const said_log *const once = user;
    const uint32_t before = once->said->count;
    uint32_t index;
    if (!ffd_intern(once->said, line, strlen(line), &index) || index == before)
        once->log.function(once->log.user, level, line);
}

/* Runs the pass for one target. Its warnings name it; warnings about the file come with the first one
   only. */
static ffd_status add_target(deform_job *job, size_t k, const morph_steps *steps, const mesh_log *log,
                             ffd_job_result *result, ffd_error *error)
{
    const ffd_deform_desc *const all = job->desc;
    const char *const name = all->morphs[k];
    mesh_log_label label;
    ffd_deform_desc one = *all;
    one.lattices = all->lattices + k;
    one.lattice_count = 1;
    one.as_morph = name;
    ffd_result_clear(result);
    job->desc = &one;
    job->log = all->lattice_count > 1 ? ffd_log_morph(log, name, &label) : *log;
    said_log once = {job->log, job->animation ? &job->animation->said : NULL};
    if (job->animation)
        job->log = (mesh_log){job->log.function ? say_once : NULL, &once};
    job->file_log = k == 0 ? *log : (mesh_log){0};
    lattice_chain whole = job->chain;
    job->chain = ffd_chain_link_alone(&whole, k);
    ffd_status status;
    TRY_END(steps->before ? steps->before(steps->context, job, k, error) : FFD_OK);
    status = ffd_deform_job_run(job, result, error);
    if (steps->after && (!status || status == FFD_E_GATE)) {
        const ffd_status taken = steps->after(steps->context, job, k, error);
        status = taken ? taken : status;
    }
end:
    if (status)
        name_target(name, all->lattice_count, error);
    ffd_chain_end_alone(&job->chain);
    job->chain = whole;
    job->document_is_cached = true; /* the cache may know the locations of its vertices from now on */
    job->desc = all;
    job->log = job->file_log = *log;
    return status;
}

/* Whether memory suffices to keep u,v,w of all vertices beside the targets, and there are later targets to
   use them. */
static bool fits_budget(const deform_job *job, size_t targets)
{
    return targets > 1 && ffd_budget_check(&job->document->budget, ffd_mesh_vertex_count(job->document),
                                           sizeof(ffd_location) + targets * TARGET_BYTES, NULL) == FFD_OK;
}

/* *done: the number of targets with figures, including one that a gate refuses. */
static ffd_status add_targets(deform_job *job, const morph_steps *steps, ffd_job_result *results,
                              size_t *done, ffd_error *error)
{
    const mesh_log log = job->log;
    const size_t count = job->desc->lattice_count;
    ffd_status refused = FFD_OK;
    ffd_error own;
    job->forgets_locations = !fits_budget(job, count);
    for (size_t k = 0; k < count; k++) {
        const ffd_status status = add_target(job, k, steps, &log, &results[k], refused ? &own : error);
        const bool is_refused = status == FFD_E_GATE;
        *done += !status || is_refused;
        if (status && !(is_refused && steps->goes_on)) {
            if (refused)
                *error = own;
            return status;
        }
        refused = is_refused ? status : refused;
        ffd_log_line(&log, FFD_LOG_INFO, "morph target \"%s\": %llu of %llu %s moved, by %g at most",
                     job->desc->morphs[k], (unsigned long long)results[k].moved,
                     (unsigned long long)results[k].vertices,
                     ffd_plural(results[k].vertices, "vertex", "vertices"), results[k].displacement.max);
    }
    return refused;
}

ffd_status ffd_morphs_run_each(deform_job *job, const morph_steps *steps, ffd_job_result *result,
                               ffd_error *error)
{
    const ffd_deform_desc *const desc = job->desc;
    ffd_job_result *const own = desc->morph_results ? NULL : ffd_alloc_zero(desc->lattice_count, sizeof *own);
    ffd_job_result *const results = desc->morph_results ? desc->morph_results : own;
    if (!results)
        return ffd_fail_memory(error);
    size_t done = 0;
    const ffd_status status = add_targets(job, steps, results, &done, error);
    if (!status || status == FFD_E_GATE) {
        ffd_results_join(results, done, result);
        result->morphs.count = done;
        result->morphs.names = desc->morphs;
        result->morphs.lattices = desc->lattices;
        result->morphs.results = desc->morph_results;
    }
    ffd_free(own);
    return status;
}

/* Normals do not add up as positions do. */
static void warn_of_normals(const deform_job *job)
{
    size_t with_normals = 0;
    for (size_t i = 0; i < job->document->part_count; i++)
        with_normals += job->document->parts[i].normal_count > 0;
    if (job->animation && with_normals > 0 && job->desc->normals != FFD_NORMALS_KEEP)
        ffd_log_line(&job->log, FFD_LOG_WARNING,
                     "normals are those of each morph target alone, mixed by its weight: an approximation "
                     "between them ({normals=keep} leaves them out)");
}

ffd_status ffd_morphs_run(deform_job *job, ffd_job_result *result, ffd_error *error)
{
    const morph_steps steps = {.before = keep_base, .after = keep_shape};
    warn_of_normals(job);
    TRY(keep_clips(job, error));
    TRY(begin(job, error));
    return ffd_morphs_run_each(job, &steps, result, error);
}
