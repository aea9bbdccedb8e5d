/* fit_job.c - the job of `ffd fit`. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/text/buffer.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "job/author/author_job.h"
#include "job/author/fit_input.h"
#include "job/chain/lattice_memory.h"
#include "job/input/source.h"
#include "job/job_call.h"
#include "job/reads.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The bytes of a pair beside its places and weight. */
#define PAIR_BYTES 290

void ffd_fit_job_init(ffd_fit_job *job, size_t size)
{
    const ffd_fit_job defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, job, size);
}

/* A job at work. */
typedef struct fit_run {
    ffd_fit_job desc; /* what is in memory has names */
    author_job author;
    fit_input input;
    author_input base; /* its lattice is that of the job, or made here */
    ffd_lattice *laid; /* made here */
    ffd_lattice *made;
    ffd_fit_job_result *result;
} fit_run;

static bool has_base(const ffd_author_desc *desc)
{
    return desc->lattice.path || desc->lattice.text.data || desc->lattice.object;
}

static bool is_file(const char *weights)
{
    return weights && strcmp(weights, "area") != 0 && strcmp(weights, "uniform") != 0;
}

#define REFUSE(...) ffd_fail(error, FFD_E_ARGUMENT, __VA_ARGS__)

/* Settings of the pairs that do not go together. */
static ffd_status check_pairs(const fit_run *run, ffd_error *error)
{
    const ffd_fit_job *const desc = &run->desc;
    if (!desc->pairs && !(desc->before && desc->after))
        return REFUSE("there is nothing to fit: {before} and {after}, or {pairs}");
    if (desc->pairs && desc->after)
        return REFUSE("{after} and {pairs} cannot be used together");
    if (desc->handles && !desc->pairs)
        return REFUSE("{handles} needs {pairs}");
    if (desc->weights && desc->pairs)
        return REFUSE("{weights} is for two meshes: rows of {pairs} have their own");
    if (desc->robust && desc->handles)
        return REFUSE("{robust} does not go with {handles}");
    if (run->input.only_count > 0 && !desc->before)
        return REFUSE("{only} chooses parts of {before}, but there is none");
    if (desc->before && ffd_fit_is_array(&run->input.before) &&
        (run->input.only_count > 0 || run->input.before.space != FFD_SPACE_SCENE))
        return REFUSE("{only} and {space} are for a mesh: {before} is an array");
    return FFD_OK;
}

static ffd_status check_settings(const fit_run *run, ffd_error *error)
{
    const ffd_fit_job *const desc = &run->desc;
    const ffd_author_desc *const author = &run->author.desc;
    TRY(check_pairs(run, error));
    if (has_base(author) && desc->lattice)
        return REFUSE("a box is described, but {lattice} has its own");
    if (!has_base(author) && (author->set_count > 0 || author->has_time))
        return REFUSE("{set} and {time} are for {lattice}, but there is none");
    if (!ffd_isa_available(desc->isa))
        return REFUSE("{isa}: this build or this processor does not support the instruction set %s",
                      ffd_isa_name(desc->isa));
    if (desc->fail_on & ~(unsigned)FFD_GATE_FOLDS)
        return REFUSE("{fail_on} of this job can be folds only");
    if (!(desc->snap >= 0 && isfinite(desc->snap)))
        return REFUSE("the snap %g is not a length", desc->snap);
    if (!(desc->timeout >= 0))
        return REFUSE("{timeout} must be at least 0");
    if (desc->smoothing == FFD_FIT_WITHIN && !(desc->within >= 0 && isfinite(desc->within)))
        return REFUSE("{within} must be at least 0, not %g", desc->within);
    return FFD_OK;
}

/* Whether a job reads this output as a mesh, or as an array. */
static bool reads_source(const ffd_source *source, const char *output)
{
    if (!ffd_fit_is_array(source))
        return ffd_job_reads_mesh(source, output);
    return !source->bytes.data && ffd_file_same(source->path, output);
}

/* What is read is never replaced, not with force either. */
static ffd_status check_output(const fit_run *run, ffd_error *error)
{
    const ffd_fit_job *const desc = &run->desc;
    const char *const output = run->author.desc.output;
    if (run->author.desc.sink || !output)
        return FFD_OK;
    if ((desc->before && reads_source(&run->input.before, output)) ||
        (desc->after && reads_source(&run->input.after, output)) ||
        (desc->pairs && !desc->pairs_bytes.data && ffd_file_same(desc->pairs, output)) ||
        (is_file(desc->weights) && !desc->weights_bytes.data && ffd_file_same(desc->weights, output)))
        return ffd_fail_file(error, FFD_E_EXISTS, output, "is an input of this command");
    return FFD_OK;
}

/* Lays a lattice of its own round what is fitted. */
static ffd_status lay(fit_run *run, ffd_error *error)
{
    ffd_lattice_desc desc;
    lattice_spec spec = {.count = 1};
    ffd_lattice_desc_init(&desc, sizeof desc);
    for (int a = 0; a < 3; a++) {
        desc.size[a] = 6;
        desc.knots[a] = FFD_KNOTS_OPEN;
    }
    if (run->desc.lattice)
        TRY(ffd_struct_take(&desc, sizeof desc, run->desc.lattice, "ffd_lattice_desc", error));
    bool fits = true; /* a size that does not is refused by ffd_lattice_create */
    for (int a = 0; a < 3 && fits; a++) {
        fits = desc.size[a] > 0 && desc.size[a] <= FFD_MAX_CONTROL_POINTS / spec.count;
        spec.size[a] = desc.size[a];
        spec.degree[a] = desc.degree[a] > 0 && desc.degree[a] <= FFD_MAX_DEGREE ? desc.degree[a] : 3;
        spec.count *= fits ? desc.size[a] : 1;
    }
    TRY(fits ? ffd_lattice_memory_take(&run->base.memory, &spec, 0, error) : FFD_OK);
    return ffd_lattice_create(&desc, run->input.places, run->input.place_count, &run->laid, error);
}

/* Reads the pairs, and the base, or makes it. */
static ffd_status read(fit_run *run, ffd_error *error)
{
    const ffd_author_desc *const desc = &run->author.desc;
    TRY(ffd_author_check(&run->author, error));
    TRY(ffd_fit_input_read(&run->input, error));
    run->author.laid = &run->input.box;
    TRY(ffd_author_begin(&run->author, &run->base, error));
    run->base.memory.most += run->input.room;
    TRY(desc->sink ? FFD_OK : ffd_job_check_box(desc->output, &run->input.box.files, &desc->lattice, error));
    if (run->author.lattice_count == 0)
        TRY(lay(run, error));
    ffd_free(run->input.places);
    run->input.places = NULL;
    return ffd_budget_take(&run->base.memory, run->input.count, PAIR_BYTES * (run->desc.symmetric ? 2 : 1),
                           error);
}

/* Names the lattice in what is wrong with it, before the pairs are looked at. */
static ffd_status check_base(const fit_run *run, ffd_error *error)
{
    const ffd_lattice *const base = run->base.lattices[0];
    ffd_embedding_desc desc;
    ffd_embedding *embedding = NULL;
    ffd_lattice *symmetric = NULL;
    ffd_status status;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = base;
    desc.points = (ffd_span){.data = run->input.sources, .count = 1};
    if (base->weights_moved)
        TRY_END(ffd_fail(error, FFD_E_UNSUPPORTED, "its weights move: a fit finds offsets"));
    TRY_END(ffd_embedding_create(&desc, NULL, &embedding, error));
    if (run->desc.symmetric >= 1 && run->desc.symmetric <= 3)
        TRY_END(ffd_lattice_symmetrize(base, run->desc.symmetric - 1, true, &symmetric, error));
end:
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&symmetric);
    if (status && status != FFD_E_LIMIT && status != FFD_E_MEMORY && run->author.desc.lattice.path)
        ffd_fail_name_file(error, run->author.desc.lattice.path);
    return status;
}

static double diagonal_of(const ffd_bounds *of)
{
    double sides[3];
    for (int a = 0; a < 3; a++)
        sides[a] = of->max[a] - of->min[a];
    return vec_length(sides);
}

static ffd_status fit(fit_run *run, ffd_error *error)
{
    const ffd_fit_job *const job = &run->desc;
    const fit_input *const input = &run->input;
    ffd_fit_desc desc;
    ffd_run_options options;
    ffd_fit_desc_init(&desc, sizeof desc);
    ffd_run_options_init(&options, sizeof options);
    desc.base = run->laid ? run->laid : run->base.lattices[0];
    desc.source = (ffd_span){.data = input->sources, .count = input->count};
    desc.target = (ffd_span){.data = input->targets, .count = input->count};
    desc.weights = input->weights;
    desc.exact = input->table.exact;
    desc.exact_count = input->table.exact_count;
    desc.handles = job->handles;
    desc.robust = job->robust;
    desc.symmetric = job->symmetric;
    desc.smoothing = job->smoothing;
    desc.smooth = job->smooth;
    desc.within = job->within * (job->within_relative ? diagonal_of(&input->bounds) : 1);
    desc.snap = job->snap * (job->snap_relative ? desc.base->diagonal : 1);
    desc.numbered_from = job->pairs ? 1 : 0;
    options.threads = run->author.desc.threads;
    options.isa = job->isa;
    run->result->fit.struct_size = sizeof run->result->fit;
    TRY(run->laid ? FFD_OK : check_base(run, error));
    TRY(ffd_fit_points(&desc, &options, &run->made, NULL, &run->result->fit, error));
    run->result->is_fitted = true;
    return FFD_OK;
}

/* Tells of what a user would not expect. */
static void warn(const fit_run *run)
{
    const ffd_fit_result *const r = &run->result->fit;
    const uint64_t unused = r->outside + r->multiple + r->singular;
    char name[100];
    ffd_name_shown(run->input.name, name, sizeof name);
    if (unused > 0)
        ffd_log_line(&run->author.log, FFD_LOG_WARNING,
                     "%s: %" PRIu64 " of %" PRIu64 " pairs are not used: %" PRIu64
                     " outside the lattice, %" PRIu64 " with several u,v,w, %" PRIu64
                     " where it is not invertible",
                     name, unused, r->pairs, r->outside, r->multiple, r->singular);
    if (run->input.weightless > 0)
        ffd_log_line(&run->author.log, FFD_LOG_WARNING,
                     "%s: %zu of %" PRIu64 " vertices have no area round them, and count for nothing "
                     "({weights=uniform} counts all alike)",
                     name, run->input.weightless, r->pairs);
    if (r->folds.verdict != FFD_FOLDS_NONE)
        ffd_log_line(&run->author.log, FFD_LOG_WARNING, "%s: the lattice that is found %s", name,
                     r->folds.verdict == FFD_FOLDS_SOME ? "folds" : "is not proven to be without folds");
}

static ffd_status judge(const fit_run *run, ffd_error *error)
{
    if (!(run->desc.fail_on & FFD_GATE_FOLDS) || run->result->fit.folds.verdict == FFD_FOLDS_NONE)
        return FFD_OK;
    return ffd_fail(error, FFD_E_GATE, "the lattice that is found %s ({fail_on=folds})",
                    run->result->fit.folds.verdict == FFD_FOLDS_SOME ? "folds"
                                                                     : "is not proven to be without folds");
}

static ffd_status run_job(fit_run *run, ffd_error *error)
{
    const double start = ffd_clock_seconds();
    ffd_fit_seconds *const seconds = &run->result->seconds;
    ffd_status status;
    TRY_END(check_settings(run, error));
    TRY_END(check_output(run, error));
    TRY_END(read(run, error));
    const double before = ffd_clock_seconds();
    seconds->read = before - start;
    status = fit(run, error);
    const double after = ffd_clock_seconds();
    seconds->fit = after - before;
    TRY_END(status);
    TRY_END(judge(run, error));
    warn(run);
    TRY_END(ffd_deadline_check(error));
    TRY_END(ffd_author_write(&run->author, run->made, error));
    seconds->write = ffd_clock_seconds() - after;
end:
    if (status && status != FFD_E_ARGUMENT && run->input.name)
        ffd_fail_name_file(error, run->input.name);
    ffd_lattice_destroy(&run->made);
    ffd_lattice_destroy(&run->laid);
    ffd_author_end(&run->base);
    ffd_fit_input_free(&run->input);
    return status;
}

/* An array in memory is not a mesh. */
static ffd_status take_source(fit_run *run, const ffd_source *callers, const char *name, ffd_source *source,
                              ffd_error *error)
{
    if (!callers)
        return FFD_OK;
    *source = *callers;
    if (source->bytes.data && source->path && ffd_path_has_ending(source->path, ".npy"))
        return ffd_in_memory_bytes(source->bytes, name, &source->path, error);
    TRY(ffd_in_memory_source(&run->author.memory, source, error));
    return source->path ? FFD_OK : ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
}

/* Takes the description of the caller; what concerns the base and the output as other jobs of lattices. */
static ffd_status take(const ffd_fit_job *callers, fit_run *run, ffd_error *error)
{
    ffd_fit_job *const desc = &run->desc;
    ffd_author_desc author;
    ffd_author_desc_init(&author, sizeof author);
    TRY(ffd_struct_take(&author, sizeof author, callers->job, "ffd_author_desc", error));
    run->input = (fit_input){
        .job = desc, .only = author.only, .only_count = author.only_count, .author = &run->author};
    author.only = NULL;
    author.only_count = 0;
    author.meshes = desc->cover;
    author.mesh_count = desc->cover_count;
    TRY(ffd_author_take(&author, &run->author, error));
    run->author.lattice_count = has_base(&run->author.desc) ? 1 : 0;
    TRY(take_source(run, desc->before, "before.npy", &run->input.before, error));
    TRY(take_source(run, desc->after, "after.npy", &run->input.after, error));
    TRY(ffd_in_memory_bytes(desc->pairs_bytes, "pairs.csv", &desc->pairs, error));
    TRY(ffd_in_memory_bytes(desc->weights_bytes, "weights.npy", &desc->weights, error));
    run->input.name = desc->pairs ? desc->pairs : desc->before ? ffd_source_name(&run->input.before) : NULL;
    run->result->robust = desc->robust;
    run->result->has_rows = desc->pairs;
    return FFD_OK;
}

static ffd_status call(const ffd_fit_job *callers, ffd_fit_job_result *result, ffd_error *error)
{
    fit_run run = {.result = result};
    work_watch watch;
    deadline limit;
    ffd_status status;
    ffd_fit_job_init(&run.desc, sizeof run.desc);
    TRY(ffd_struct_take(&run.desc, sizeof run.desc, callers, "ffd_fit_job", error));
    if (!run.desc.job)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    TRY_END(take(&run.desc, &run, error));
    watch = (work_watch){.progress = run.desc.progress, .user = run.desc.progress_user};
    const deadline *const before = ffd_deadline_begin(&limit, run.desc.timeout, &watch);
    status = run_job(&run, error);
    ffd_deadline_end(before);
    ffd_job_watch_end(&watch, status);
end:
    return ffd_author_leave(&run.author, status, error);
}

ffd_status ffd_fit_run(const ffd_fit_job *callers, ffd_fit_job_result *callers_result, ffd_error *error)
{
    ffd_fit_job_result result = {.struct_size = sizeof result};
    if (callers_result)
        TRY(ffd_struct_check(sizeof result, callers_result, "ffd_fit_job_result", error));
    result.status = call(callers, &result, &result.error);
    if (result.status && error)
        *error = result.error;
    if (callers_result)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return result.status;
}

static const char *folds_text(ffd_fold_verdict verdict)
{
    return verdict == FFD_FOLDS_NONE   ? "no folds"
           : verdict == FFD_FOLDS_SOME ? "folds"
                                       : "folds not excluded";
}

ffd_status ffd_fit_text(const ffd_fit_job_result *callers, char **text, ffd_error *error)
{
    ffd_fit_job_result result = {.struct_size = sizeof result};
    byte_buffer line = {0};
    *text = NULL;
    TRY(ffd_struct_take(&result, sizeof result, callers, "ffd_fit_job_result", error));
    const ffd_fit_result *const r = &result.fit;
    ffd_buffer_format(
        &line, "fit: %" PRIu64 " pairs, residual rms %.2g max %.2g (%s %" PRIu64 "), smooth %.3g (%s), %s",
        r->pairs, r->residual_rms, r->residual_max, result.has_rows ? "row" : "vertex",
        r->worst + (result.has_rows ? 1 : 0), r->smooth, ffd_fit_choice_name(r->smooth_chosen_by),
        folds_text(r->folds.verdict));
    *text = ffd_buffer_finish(&line);
    return *text ? FFD_OK : ffd_fail_memory(error);
}
