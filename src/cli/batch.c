/* batch.c - ffd batch: many jobs, from a manifest, a table or a pattern. */
#include "batch/batch.h"
#include "base/file/path.h"
#include "cli/command.h"
#include "cli/deform.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    cli_deform_settings jobs; /* for checking the options that a job can have */
    const char *journal, *table, *ignored, *pattern, *view, *positions;
    int type; /* index into type_names; negative: not given */
    int at_once;
    uint64_t shard, shards;
    double timeout;
    bool resume, stop, keep_going, dry;
} settings;

static bool set_shard(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    char *end;
    errno = 0;
    const unsigned long long shard = strtoull(value, &end, 10);
    const bool slash = *value >= '0' && *value <= '9' && *end == '/' && end[1] >= '0' && end[1] <= '9';
    const unsigned long long shards = slash ? strtoull(end + 1, &end, 10) : 0;
    if (!slash || *end || errno || shard >= shards) {
        cli_complain("--%s: \"%s\" is not I/N with I from 0 to N-1", option->name, value);
        return false;
    }
    s->shard = shard;
    s->shards = shards;
    return true;
}

static const char *const type_names[] = {"f4", "f8", NULL};

#define AT(field) offsetof(settings, field)
static const cli_option own_options[] = {
    {"jobs", 'j', "N", "jobs at the same time; default one per processor, as far as memory allows",
     cli_set_count, AT(at_once), NULL},
    {"shard", 0, "I/N", "only every N-th job, beginning with job I; I from 0", set_shard, 0, NULL},
    {"resume", 0, NULL, "leave outputs that are up to date by content; replace others", cli_set_flag,
     AT(resume), NULL},
    {"journal", 0, "FILE", "where --resume records what outputs were made from; default in the user's cache",
     cli_set_text, AT(journal), NULL},
    {"timeout", 0, "SECONDS", "longest time that a job may take", cli_set_positive, AT(timeout), NULL},
    {"stop", 0, NULL, "begin no more jobs after one has failed", cli_set_flag, AT(stop), NULL},
    {"keep-going", 0, NULL, "do all jobs, even if some fail; the default", cli_set_flag, AT(keep_going),
     NULL},
    {"dry-run", 0, NULL, "only print what would be done", cli_set_flag, AT(dry), NULL},
    {"in", 0, "GLOB", "without MANIFEST: these meshes; with --csv: the mesh of all rows", cli_set_text,
     AT(pattern), NULL},
    {"csv", 0, "TABLE", "one job per row: columns in, lattice, out; others set placeholders of the lattice",
     cli_set_text, AT(table), NULL},
    {"csv-ignore", 0, "COLUMN,...", "leave these columns of the table out", cli_set_text, AT(ignored), NULL},
    {"view", 0, "DIR",
     "draw each job before and after into this folder, and an index.html that compares them", cli_set_text,
     AT(view), NULL},
    {"positions", 0, "ALL.npy",
     "one array of all deformed positions, jobs x vertices x 3, and ALL.json; meshes need \"out\"",
     cli_set_text, AT(positions), NULL},
    {"dtype", 0, "f4|f8", "numbers of --positions: float32 or float64; default f4", cli_set_choice, AT(type),
     type_names},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* Returns what is wrong with the options for the array of positions, or NULL. */
static const char *wrong_positions(const settings *s, const cli_words *words)
{
    const cli_deform_settings *jobs = &s->jobs;
    if (!s->positions)
        return s->type >= 0 ? "--dtype needs --positions" : NULL;
    if (cli_is_stream(s->positions))
        return "--positions needs the name of a file: its rows are written as the jobs come";
    if (!ffd_path_has_ending(s->positions, ".npy"))
        return "--positions needs a name that ends in .npy";
    if (jobs->job.desc.in_place)
        return "--in-place cannot be used with --positions";
    if (jobs->job.desc.morphs)
        return "--morph cannot be used with --positions: a row is of one deformation";
    if (jobs->depfile_path)
        return "--depfile cannot be used with --positions: its rules are for meshes";
    if (words->count && cli_is_stream(words->words[0]))
        return "--positions reads the jobs twice, but standard input can be read only once";
    return NULL;
}

static const char *wrong(const settings *s, const cli_words *words)
{
    const cli_deform_settings *jobs = &s->jobs;
    const bool manifest = words->count == 1;
    if (words->count > 1)
        return "more than one MANIFEST";
    if (!manifest && !s->table && !s->pattern)
        return "needs MANIFEST, or --in, or --csv";
    if (manifest && (s->table || s->pattern || jobs->out_dir || jobs->job.desc.lattice_count))
        return "MANIFEST cannot be used with --in, --csv, --lattice, --morph or --out-dir";
    if (s->ignored && !s->table)
        return "--csv-ignore needs --csv";
    if (!manifest && !s->table && !jobs->job.desc.lattice_count)
        return "--in needs a lattice (-l FILE)";
    if (cli_job_mixes_morphs(&jobs->job))
        return "-l cannot be used with --morph: each --morph names its own lattice";
    if (!manifest && !s->table && !jobs->out_dir && !jobs->job.desc.in_place && !s->positions)
        return "--in needs --out-dir, --in-place or --positions";
    if (jobs->job.desc.in_place && jobs->out_dir)
        return "--in-place and --out-dir cannot be used together";
    if (s->stop && s->keep_going)
        return "--stop and --keep-going cannot be used together";
    if (jobs->job.stable && !jobs->job.report && !s->positions)
        return "--report-stable needs --report or --positions";
    if (s->resume && jobs->job.desc.in_place)
        return "--in-place cannot be used with --resume: a finished mesh would be deformed again";
    if (s->view && jobs->job.desc.in_place)
        return "--in-place cannot be used with --view: a picture is named after OUT";
    if (jobs->depfile_path && jobs->job.desc.in_place)
        return "--depfile cannot be used with --in-place: a file cannot depend on itself";
    if (s->dry && jobs->job.report && cli_is_stream(jobs->job.report))
        return "--dry-run and the report cannot both write to standard output";
    return wrong_positions(s, words);
}

static int run_batch(const settings *s, const cli_words *words)
{
    const cli_job *job = &s->jobs.job;
    const batch_desc desc = {.jobs = {.manifest = words->count ? words->words[0] : NULL,
                                      .table = s->table,
                                      .ignored = s->ignored,
                                      .pattern = s->pattern,
                                      .out_dir = s->jobs.out_dir,
                                      .defaults = &job->desc,
                                      .ending = s->jobs.output_ending,
                                      .resume = s->resume,
                                      .pictures = s->view != NULL,
                                      .positions = s->positions != NULL,
                                      .strict = job->desc.input.strict,
                                      .shard = s->shard,
                                      .shards = s->shards ? s->shards : 1},
                             .pool = {.workers = s->at_once,
                                      .threads = job->desc.threads,
                                      .timeout = s->timeout,
                                      .wishes = {.resume = s->resume,
                                                 .dry = s->dry,
                                                 .stable = job->stable,
                                                 .quiet = job->logging.quiet,
                                                 .verbose = job->logging.verbose && !job->logging.quiet}},
                             .report = job->report,
                             .depfile = s->jobs.depfile_path,
                             .journal = s->journal,
                             .view = s->view,
                             .positions = s->positions,
                             .positions_double = s->type > 0,
                             .force = job->desc.force || job->desc.if_changed,
                             .shared_box = job->shares_box,
                             .stop = s->stop,
                             .quiet = job->logging.quiet};
    bool failed;
    ffd_error error;
    if (ffd_batch_run(&desc, &failed, &error))
        return cli_fail(&error);
    return failed ? EXIT_NO : EXIT_DONE;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    const settings *const s = context;
    const char *const why = wrong(s, words);
    return why ? cli_usage(command, why) : run_batch(s, words);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {.type = -1};
    return cli_job_run(command, &s.jobs.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"the jobs of a manifest, two at a time", "ffd batch jobs.jsonl -j 2 --report report.json"},
    {"go on where a run was stopped", "ffd batch jobs.jsonl --resume"},
    {"a folder of meshes", "ffd batch --in 'meshes/*.obj' -l bend.json --out-dir out"},
    {"variants of one mesh, a row of a table each, as one array",
     "ffd batch --csv table.csv --in vase.obj -l swept.json --positions all.npy"},
    {NULL, NULL},
};

const cli_command cli_batch = {
    "batch",
    "run many jobs",
    "usage: ffd batch MANIFEST [options]\n"
    "       ffd batch --in GLOB -l LATTICE --out-dir DIR [options]\n"
    "       ffd batch --csv TABLE [--in IN] [-l LATTICE] [--out-dir DIR] [options]\n"
    "       MANIFEST: a job a line, as {\"in\": \"a.glb\", \"lattice\": \"x.json\",\n"
    "       \"out\": \"o/a.glb\", \"options\": {\"normals\": \"keep\"}}; - is standard input\n"
    "       exit 1: a job failed\n",
    {own_options, cli_job_options, cli_deform_options},
    run,
    "MANIFEST",
    examples};
