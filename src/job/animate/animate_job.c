/* animate_job.c - the job of `ffd animate`: plans targets and weights, and runs a job of `ffd deform` with
 * them. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/struct_size.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "job/animate/animation.h"
#include "job/chain/chain_load.h"
#include "job/conversion.h"
#include "job/deform_job.h"
#include "job/input/deform_desc.h"
#include "job/input/settings.h"
#include "job/input/shown_box.h"
#include "job/job_call.h"
#include "lattice/file/lattice_time.h"
#include "lattice/spec.h"
#include "mesh/morph/morph_clip.h"
#include "json/json_chars.h"
#include <ffd/animate.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* As of a job of several lattices. */
#define MOST_TARGETS 1024
/* Of the diagonal: a control point that is so far from rest moves nothing. */
#define STILL 1e-12

/* The state of a job. */
typedef struct animate_job {
    ffd_animate_desc desc;
    ffd_animate_result *result;
    job_call *call;
    job_animation animation;
    double tolerance; /* world units */
    path_samples samples;
    animation_plan plan;
    morph_clip clip;
    ffd_lattice_source *sources; /* target_count; */
    char **names;                /* target_count */
    ffd_lattice *made[1];        /* where nothing moves: the lattice at rest */
} animate_job;

void ffd_animate_desc_init(ffd_animate_desc *desc, size_t size)
{
    const ffd_animate_desc defaults = {
        .struct_size = sizeof defaults, .tolerance = 1e-3, .relative = true, .frames_per_second = 60};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* Refuses settings of a deformation that an animation has no use for. */
static ffd_status refuse_settings(const ffd_deform_desc *job, ffd_error *error)
{
    static const char *const none[] = {"as_morph",   "morphs",        "clips",   "blocks",
                                       "rig=follow", "embedding",     "fail_on", "positions",
                                       "in_place",   "output_format", "time",    "normals=recompute"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        char text[64];
        if (!ffd_setting_is_set(job, none[i]))
            continue;
        snprintf(text, sizeof text, "{%s} cannot be used with an animation", none[i]);
        return ffd_fail(error, FFD_E_ARGUMENT, "%s", SPELLED(text));
    }
    return FFD_OK;
}

static ffd_status check_numbers(const ffd_animate_desc *desc, ffd_error *error)
{
    if (!(desc->tolerance > 0) || !isfinite(desc->tolerance))
        return ffd_fail(error, FFD_E_ARGUMENT, "the tolerance %g is not a length above 0", desc->tolerance);
    if (!(desc->frames_per_second >= 1 && desc->frames_per_second <= 1000))
        return ffd_fail(error, FFD_E_ARGUMENT, "the frames per second are 1 to 1000, not %g",
                        desc->frames_per_second);
    if (desc->targets > FFD_TARGETS_COUNT || (desc->targets == FFD_TARGETS_COUNT && desc->count == 0))
        return ffd_fail(error, FFD_E_ARGUMENT, "an animation has at least one morph target");
    return FFD_OK;
}

static ffd_status check_output(const ffd_deform_desc *job, ffd_error *error)
{
    if (!job->output)
        return ffd_fail(error, FFD_E_ARGUMENT, "no output is given");
    const char *const input = job->input.path ? job->input.path : "";
    if (ffd_conversion_keeps(job->input.format ? job->input.format : ffd_format_from_name(input)))
        return ffd_fail_file(error, FFD_E_ARGUMENT, input,
                             "a mesh of volumes keeps its format, which has no animations");
    const ffd_format format = ffd_format_from_name(job->output);
    return format == FFD_FORMAT_GLTF || format == FFD_FORMAT_GLB
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_ARGUMENT, job->output,
                               "cannot hold an animation: only .glb, .gltf and .vrm can");
}

static ffd_status check(const animate_job *a, const ffd_deform_desc *job, ffd_error *error)
{
    TRY(check_numbers(&a->desc, error));
    TRY(refuse_settings(job, error));
    TRY(check_output(job, error));
    return job->lattice_count == 1
               ? FFD_OK
               : ffd_fail(error, FFD_E_ARGUMENT, "an animation has one lattice, not %zu", job->lattice_count);
}

/* Names the animation after the lattice, if the caller does not. */
static ffd_status choose_name(animate_job *a, ffd_error *error)
{
    char *const stem = a->desc.name ? NULL : ffd_path_stem(a->call->desc.lattices[0].path);
    const char *const name = a->desc.name ? a->desc.name : stem ? ffd_path_name(stem) : NULL;
    ffd_status status = FFD_OK;
    char shown[80];
    if (!name)
        return ffd_fail_memory(error);
    ffd_name_shown(name, shown, sizeof shown);
    if (!*name || strlen(name) >= sizeof a->result->name || !ffd_utf8_is_valid(name, strlen(name)))
        status = ffd_fail(error, FFD_E_ARGUMENT,
                          "\"%s\" is not the name of an animation: 1 to %d bytes of UTF-8 ({name})", shown,
                          FFD_ANIMATION_NAME - 1);
    else
        snprintf(a->result->name, sizeof a->result->name, "%s", name);
    ffd_free(stem);
    return status;
}

/* Measures the box round the mesh, for a lattice that goes round it. */
static ffd_status fit(const animate_job *a, ffd_lattice *lattice, ffd_error *error)
{
    const ffd_deform_desc *const job = &a->call->desc;
    const mesh_log none = {0};
    shown_box box;
    path_list files = {0};
    ffd_status status;
    ffd_shown_box_clear(&box);
    TRY_END(ffd_shown_box_add(&box, &job->input, job->only, job->only_count, &files, &none, error));
    const fit_extent extent = ffd_shown_box_extent(&box);
    if (!(box.all.min[0] <= box.all.max[0]))
        TRY_END(ffd_fail_file(error, FFD_E_INVALID, job->input.path,
                              "there is no vertex that the lattice could go round"));
    TRY_END(ffd_lattice_fit_extent(lattice, &extent, error));
end:
    ffd_paths_free(&files);
    return status;
}

static ffd_status load(const animate_job *a, memory_budget *budget, ffd_lattice **lattice, ffd_error *error)
{
    const ffd_deform_desc *const job = &a->call->desc;
    const mesh_log log = {job->log, job->log_user};
    const chain_files files = {.lattices = job->lattices,
                               .count = 1,
                               .set = job->set,
                               .set_count = job->set_count,
                               .mesh = &job->input,
                               .shared = job->shared_box,
                               .log = &log};
    path_list box_files = {0};
    const ffd_status status = ffd_chain_load_lattices(&files, budget, lattice, &box_files, error);
    ffd_paths_free(&box_files);
    TRY(status);
    if (!ffd_lattice_has_keys(*lattice))
        return ffd_fail_file(error, FFD_E_INVALID, job->lattices[0].path,
                             "has no keys: there is nothing to animate");
    return (*lattice)->rest ? FFD_OK : fit(a, *lattice, error);
}

/* Chooses targets, weights and times. */
static ffd_status choose(animate_job *a, const ffd_lattice *lattice, memory_budget *budget, ffd_error *error)
{
    const path_samples *const samples = &a->samples;
    const bool counts = a->desc.targets == FFD_TARGETS_COUNT;
    const plan_wish wish = {a->desc.targets, a->desc.count, a->tolerance, STILL * lattice->diagonal};
    TRY(ffd_animation_choose(samples, lattice->spec->keys.kind == KEYS_POINTS, &wish, budget, &a->plan,
                             error));
    if (a->desc.targets == FFD_TARGETS_KEYS || a->plan.target_count == 0)
        return FFD_OK;
    double most = a->tolerance;
    if (counts) {
        double all = 0;
        for (size_t k = 0; k < samples->count; k++) {
            const double miss =
                ffd_animation_miss(samples, &a->plan, k, a->plan.weights + k * a->plan.target_count);
            all = miss > all ? miss : all;
        }
        most = all + samples->chord + a->tolerance / 2;
    }
    return ffd_animation_drop_times(samples, most, &a->plan, error);
}

/* Makes a copy of the lattice whose control points are those of a sample. */
static ffd_status make_target(const animate_job *a, const ffd_lattice *lattice, size_t sample,
                              ffd_lattice **made, ffd_error *error)
{
    TRY(ffd_lattice_copy(lattice, made, error));
    return ffd_lattice_set_offsets(*made, NULL, lattice->count,
                                   a->samples.offsets + sample * a->samples.width, error);
}

static ffd_status make_name(const animate_job *a, size_t target, char **name, ffd_error *error)
{
    const size_t size = sizeof a->result->name + 24;
    *name = ffd_alloc(size, 1);
    if (!*name)
        return ffd_fail_memory(error);
    snprintf(*name, size, "%s-%zu", a->result->name, target + 1);
    return FFD_OK;
}

/* Describes the targets as the morphs of the job. */
static ffd_status make_targets(animate_job *a, const ffd_lattice *lattice, memory_budget *budget,
                               ffd_error *error)
{
    const size_t count = a->plan.target_count;
    ffd_deform_desc *const job = &a->call->desc;
    a->names = ffd_alloc_zero(count, sizeof *a->names);
    a->sources = ffd_alloc(count, sizeof *a->sources);
    a->animation.lattices = ffd_alloc_zero(count, sizeof *a->animation.lattices);
    if (!a->names || !a->sources || !a->animation.lattices)
        return ffd_fail_memory(error);
    TRY(ffd_budget_check(budget, count, 10 * lattice->count * sizeof(double), error));
    for (size_t t = 0; t < count; t++) {
        a->sources[t] = job->lattices[0];
        TRY(make_name(a, t, &a->names[t], error));
        TRY(make_target(a, lattice, a->plan.targets[t], &a->animation.lattices[t], error));
    }
    job->morphs = (const char *const *)a->names;
    job->lattices = a->sources;
    job->lattice_count = count;
    return FFD_OK;
}

static bool add_weight(morph_clip *clip, uint32_t target, double weight)
{
    if (!ffd_grow((void **)&clip->weights, &clip->weight_capacity, clip->weight_count + 1,
                  sizeof *clip->weights))
        return false;
    clip->weights[clip->weight_count++] = (clip_weight){target, weight};
    return true;
}

/* Makes the animation of the weights. */
static ffd_status make_clip(animate_job *a, ffd_error *error)
{
    const animation_plan *const plan = &a->plan;
    morph_clip *const clip = &a->clip;
    bool whole = true;
    uint32_t index;
    clip->name = ffd_text_copy(a->result->name);
    clip->times = ffd_alloc(plan->key_count, sizeof *clip->times);
    clip->starts = ffd_alloc(plan->key_count + 1, sizeof *clip->starts);
    if (!clip->name || !clip->times || !clip->starts)
        return ffd_fail_memory(error);
    for (size_t t = 0; t < plan->target_count && whole; t++)
        whole = ffd_intern(&clip->names, a->names[t], strlen(a->names[t]), &index);
    for (size_t k = 0; k < plan->key_count && whole; k++) {
        const double *const weights = plan->weights + plan->keys[k] * plan->target_count;
        clip->times[k] = (float)a->samples.times[plan->keys[k]];
        clip->starts[k] = clip->weight_count;
        for (size_t t = 0; t < plan->target_count && whole; t++)
            if (weights[t] != 0)
                whole = add_weight(clip, (uint32_t)t, weights[t]);
    }
    clip->key_count = plan->key_count;
    clip->starts[plan->key_count] = clip->weight_count;
    a->animation.clip = clip;
    return whole ? FFD_OK : ffd_fail_memory(error);
}

/* A lattice that moves nothing takes the place of targets. */
static ffd_status make_still(animate_job *a, ffd_lattice *lattice, ffd_error *error)
{
    const mesh_log log = {a->call->desc.log, a->call->desc.log_user};
    ffd_log_line(&log, FFD_LOG_WARNING,
                 "%s moves no control point at any time: there are no morph targets, and no animation",
                 a->call->desc.lattices[0].path);
    a->animation.lattices = a->made;
    return make_target(a, lattice, 0, &a->made[0], error);
}

static void tell(const animate_job *a)
{
    const mesh_log log = {a->call->desc.log, a->call->desc.log_user};
    const ffd_animate_result *const r = a->result;
    ffd_log_line(
        &log, FFD_LOG_INFO,
        "animation \"%s\": %zu %s and %zu times of %zu samples; no vertex is farther than %.3g from its "
        "place",
        r->name, a->plan.target_count, ffd_plural(a->plan.target_count, "target", "targets"),
        a->plan.key_count, a->samples.count, r->bound);
    if (r->bound > r->tolerance)
        ffd_log_line(&log, FFD_LOG_WARNING,
                     "the animation may be %.3g from the path, more than the tolerance of %.3g ({targets}, "
                     "{tolerance})",
                     r->bound, r->tolerance);
}

/* Plans the animation, and describes it to the job of `ffd deform`. */
static ffd_status plan(job_animation *animation, ffd_error *error)
{
    animate_job *const a = animation->context;
    ffd_deform_desc *const job = &a->call->desc;
    const double start = ffd_clock_seconds();
    memory_budget budget = ffd_budget_make(job->input.memory);
    file_stamp stamp;
    ffd_lattice *lattice = NULL;
    ffd_status status;
    if (!job->input.bytes.data && ffd_file_stamp(job->input.path, &stamp))
        ffd_budget_add_file(&budget, stamp.size, 0);
    TRY_END(load(a, &budget, &lattice, error));
    a->tolerance = a->desc.tolerance * (a->desc.relative ? lattice->diagonal : 1);
    const sampling by = {a->desc.frames_per_second, a->tolerance / 4};
    TRY_END(ffd_path_sample(lattice, &by, &budget, &a->samples, error));
    TRY_END(choose(a, lattice, &budget, error));
    ffd_keys_free(&lattice->spec->keys); /* which copies need not have */
    if (a->plan.target_count > MOST_TARGETS)
        TRY_END(ffd_fail(error, FFD_E_LIMIT, "the animation would have %zu morph targets, more than %d",
                         a->plan.target_count, MOST_TARGETS));
    a->result->keys = a->plan.key_count;
    a->result->samples = a->samples.count;
    a->result->tolerance = a->tolerance;
    a->result->bound = a->plan.bound;
    a->result->largest_weight = a->plan.largest_weight;
    if (a->plan.target_count == 0) {
        TRY_END(make_still(a, lattice, error));
    } else {
        TRY_END(make_targets(a, lattice, &budget, error));
        TRY_END(make_clip(a, error));
        tell(a);
    }
    job->set_count = 0; /* the made lattices have no placeholders */
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->lattices[0].path);
    ffd_lattice_destroy(&lattice);
    ffd_path_free(&a->samples);
    a->result->seconds.plan = ffd_clock_seconds() - start;
    return status;
}

static void end(animate_job *a)
{
    for (size_t t = 0; t < a->plan.target_count; t++) {
        if (a->names)
            ffd_free(a->names[t]);
        if (a->animation.lattices)
            ffd_lattice_destroy(&a->animation.lattices[t]);
    }
    if (a->animation.lattices != a->made)
        ffd_free(a->animation.lattices);
    ffd_lattice_destroy(&a->made[0]);
    ffd_free(a->names);
    ffd_free(a->sources);
    ffd_morph_clip_free(&a->clip);
    ffd_intern_free(&a->animation.said);
    ffd_animation_free(&a->plan);
}

static void take_figures(animate_job *a, const ffd_job_result *job)
{
    ffd_animate_result *const r = a->result;
    r->vertices = job->vertices;
    r->inside = job->counts[FFD_VERTEX_INSIDE];
    r->outside = job->counts[FFD_VERTEX_OUTSIDE];
    r->multiple = job->counts[FFD_VERTEX_MULTIPLE];
    r->singular = job->counts[FFD_VERTEX_SINGULAR];
    r->invalid = job->counts[FFD_VERTEX_INVALID];
    r->seconds.read = job->seconds.read;
    r->seconds.deform = job->seconds.embed + job->seconds.deform;
    r->seconds.write = job->seconds.write;
    r->targets = a->animation.figures.targets;
    r->bytes = a->animation.figures.bytes;
    r->outputs = job->outputs;
}

static ffd_status run(const ffd_deform_desc *callers, animate_job *a, ffd_error *error)
{
    job_call call;
    ffd_job_result job = {.struct_size = sizeof job};
    ffd_status status;
    a->call = &call;
    a->animation.plan = plan;
    a->animation.context = a;
    TRY_END(ffd_job_call_begin(&call, callers, &job, error));
    TRY_END(check(a, &call.desc, &call.result.error));
    TRY_END(choose_name(a, &call.result.error));
    TRY_END(ffd_deform_call(&call, &a->animation));
end:
    call.result.morphs.names = NULL;
    status = ffd_job_call_end(&call, status, error);
    take_figures(a, &job);
    end(a);
    return status;
}

ffd_status ffd_animate_run(const ffd_animate_desc *callers, ffd_animate_result *callers_result,
                           ffd_error *error)
{
    ffd_animate_result result = {.struct_size = sizeof result};
    animate_job a = {.result = &result};
    ffd_animate_desc_init(&a.desc, sizeof a.desc);
    TRY(ffd_struct_take(&a.desc, sizeof a.desc, callers, "ffd_animate_desc", error));
    if (callers_result)
        TRY(ffd_struct_check(sizeof result, callers_result, "ffd_animate_result", error));
    result.status = a.desc.job
                        ? run(a.desc.job, &a, &result.error)
                        : ffd_fail(&result.error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (result.status && error)
        *error = result.error;
    if (callers_result)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return result.status;
}
