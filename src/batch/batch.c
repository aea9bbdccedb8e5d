/* batch.c - ffd_batch_run (public: ffd/batch.h): checks a batch, and gives its parts what is theirs. */
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/spelling.h"
#include "base/struct_size.h"
#include "base/system/worker_program.h"
#include "batch/batch_desc.h"
#include <inttypes.h>
#include <math.h>

void ffd_batch_desc_init(ffd_batch_desc *desc, size_t size)
{
    const ffd_batch_desc none = {.struct_size = sizeof none};
    ffd_struct_give(&none, sizeof none, desc, size);
}

/* Whether some lattices make morph targets, and others none. */
static bool mixes_morphs(const ffd_deform_desc *jobs)
{
    size_t named = 0;
    while (jobs->morphs && named < jobs->lattice_count && jobs->morphs[named])
        named++;
    return jobs->morphs && named < jobs->lattice_count;
}

/* Whether there is a lattice in memory, or an embedding or weights, which no other process can read. */
static bool has_memory(const ffd_deform_desc *jobs)
{
    size_t files = 0;
    while (files < jobs->lattice_count && jobs->lattices[files].path && !jobs->lattices[files].text.data &&
           !jobs->lattices[files].object)
        files++;
    return files < jobs->lattice_count || jobs->embedding.bytes.data || jobs->weight.bytes.data;
}

static bool is_stream(const char *path)
{
    return path && ffd_output_is_stream(path);
}

/* Returns what does not fit, with members in braces; NULL: nothing. jobs: the defaults. */
static const char *find_misfit(const ffd_batch_desc *d, const ffd_deform_desc *jobs)
{
    const bool has_lines = d->manifest || d->next, in_place = jobs->in_place;
    const struct {
        bool is_wrong;
        const char *why;
    } rules[] = {
        {!has_lines && !d->csv && !d->in, "needs {manifest}, or {in}, or {csv}"},
        {d->manifest && d->next, "{manifest} cannot be used with {next}"},
        {d->manifest && (d->csv || d->in || d->out_dir || jobs->lattice_count > 0),
         "{manifest} cannot be used with {in}, {csv}, {lattices}, {morphs} or {out_dir}"},
        {d->next && (d->csv || d->in || d->out_dir || jobs->lattice_count > 0),
         "{next} cannot be used with {in}, {csv}, {lattices}, {morphs} or {out_dir}"},
        {d->csv_ignore && !d->csv, "{csv_ignore} needs {csv}"},
        {!has_lines && !d->csv && jobs->lattice_count == 0, "{in} needs a lattice ({lattices})"},
        {has_memory(jobs),
         "{lattices}, {embedding} and {weight} of a batch are files: its processes read them"},
        {mixes_morphs(jobs), "{lattices} cannot be used with {morphs}: each {morphs} names its own lattice"},
        {!has_lines && !d->csv && !d->out_dir && !in_place && !d->positions,
         "{in} needs {out_dir}, {in_place} or {positions}"},
        {in_place && d->out_dir, "{in_place} and {out_dir} cannot be used together"},
        {d->report_stable && !d->report && !d->positions, "{report_stable} needs {report} or {positions}"},
        {d->resume && in_place,
         "{in_place} cannot be used with {resume}: a finished mesh would be deformed again"},
        {d->view && in_place, "{in_place} cannot be used with {view}: a picture is named after {output}"},
        {d->look && !d->view, "{look} needs {view}"},
        {d->pages && !d->view, "{pages} needs {view}"},
        {d->depfile && in_place, "{depfile} cannot be used with {in_place}: a file cannot depend on itself"},
        {d->is_program && d->dry_run && is_stream(d->report),
         "{dry_run} and the report cannot both write to standard output"},
        {is_stream(d->positions),
         "{positions} needs the name of a file: its rows are written as the jobs come"},
        {d->positions && !ffd_path_has_ending(d->positions, ".npy"),
         "{positions} needs a name that ends in .npy"},
        {d->positions && in_place, "{in_place} cannot be used with {positions}"},
        {d->positions && jobs->morphs,
         "{morphs} cannot be used with {positions}: a row is of one deformation"},
        {d->positions && d->depfile, "{depfile} cannot be used with {positions}: its rules are for meshes"},
        {d->positions && is_stream(d->manifest),
         "{positions} reads the jobs twice, but standard input can be read only once"},
        {d->workers < 0, "{workers} is less than 0"},
        {!(d->timeout >= 0), "{timeout} is not a time"},
        {d->shard > 0 && d->shard >= d->shards, "{shard} is not one of {shards}, counted from 0"},
    };
    size_t i = 0;
    while (i < sizeof rules / sizeof *rules && !rules[i].is_wrong)
        i++;
    return i < sizeof rules / sizeof *rules ? rules[i].why : NULL;
}

/* Takes the descriptions of the caller. jobs: the defaults, and look: how pictures are drawn, which desc then
   has. */
static ffd_status take(const ffd_batch_desc *callers, ffd_batch_desc *desc, ffd_deform_desc *jobs,
                       ffd_view_desc *look, ffd_error *error)
{
    ffd_view_desc_init(look, sizeof *look);
    ffd_batch_desc_init(desc, sizeof *desc);
    ffd_deform_desc_init(jobs, sizeof *jobs);
    TRY(ffd_struct_take(desc, sizeof *desc, callers, "ffd_batch_desc", error));
    if (desc->defaults)
        TRY(ffd_struct_take(jobs, sizeof *jobs, desc->defaults, "ffd_deform_desc", error));
    desc->defaults = jobs;
    if (desc->look)
        TRY(ffd_struct_take(look, sizeof *look, desc->look, "ffd_view_desc", error));
    desc->look = desc->look ? look : NULL;
    const char *const why = find_misfit(desc, jobs);
    return why ? ffd_fail(error, FFD_E_ARGUMENT, "%s", SPELLED(why)) : FFD_OK;
}

ffd_status ffd_batch_desc_check(const ffd_batch_desc *callers, ffd_error *error)
{
    ffd_batch_desc desc;
    ffd_deform_desc jobs;
    ffd_view_desc look;
    return take(callers, &desc, &jobs, &look, error);
}

static job_source_desc describe_jobs(const ffd_batch_desc *desc)
{
    const ffd_deform_desc *const jobs = desc->defaults;
    return (job_source_desc){.manifest = desc->manifest,
                             .table = desc->csv,
                             .pattern = desc->in,
                             .next = desc->next,
                             .next_user = desc->next_user,
                             .repeats = desc->repeats,
                             .ignored = desc->csv_ignore,
                             .out_dir = desc->out_dir,
                             .defaults = jobs,
                             .ending = desc->output_ending ? desc->output_ending
                                                           : ffd_format_ending(jobs->output_format),
                             .look = desc->look,
                             .resume = desc->resume,
                             .pictures = desc->view != NULL,
                             .positions = desc->positions != NULL,
                             .strict = jobs->input.strict,
                             .shard = desc->shard,
                             .shards = desc->shards ? desc->shards : 1};
}

ffd_status ffd_batch_run(const ffd_batch_desc *callers, ffd_batch_result *result, ffd_error *error)
{
    ffd_batch_desc given;
    ffd_deform_desc jobs;
    ffd_view_desc look;
    ffd_batch_result found = {.struct_size = sizeof found};
    char program[LONGEST_PATH];
    TRY(ffd_struct_check(sizeof found, result, "ffd_batch_result", error));
    ffd_status status;
    TRY_END(take(callers, &given, &jobs, &look, error));
    if (!given.is_program)
        TRY_END(ffd_worker_program_find(program, error));
    const batch_desc desc = {.given = &given,
                             .jobs = describe_jobs(&given),
                             .pool = {.workers = given.workers,
                                      .program = given.is_program ? NULL : program,
                                      .timeout = given.timeout,
                                      .wishes = {.resume = given.resume,
                                                 .dry = given.dry_run,
                                                 .stable = given.report_stable,
                                                 .quality = jobs.quality,
                                                 .result = given.ended != NULL,
                                                 .of_table = given.csv != NULL,
                                                 .quiet = given.quiet,
                                                 .verbose = given.verbose && !given.quiet}},
                             .force = jobs.force || jobs.if_changed};
    TRY_END(ffd_batch_do(&desc, &found, error));
end:
    ffd_struct_give(&found, sizeof found, result, result->struct_size);
    return status;
}
