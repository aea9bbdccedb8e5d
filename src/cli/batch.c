/* batch.c - ffd batch: many jobs, from a manifest, a table or a pattern. */
#include "cli/command.h"
#include "cli/deform.h"
#include "cli/look.h"
#include <errno.h>
#include <ffd/batch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    cli_deform_settings jobs; /* for checking the options that a job can have */
    const char *journal, *table, *ignored, *pattern, *view, *positions;
    int type; /* index into type_names; negative: not given */
    int at_once;
    uint64_t shard, shards;
    double timeout;
    cli_look look; /* of the pictures */
    ffd_view_desc drawn;
    char needs[60]; /* which option needs another one */
    bool resume, stop, keep_going, dry, pages;
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
    {"jobs", 'j', "N", "jobs at the same time, 1 to 1024; default one per processor, as far as memory allows",
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
    {"pages", 0, NULL, "with --view: a page of each job beside its picture", cli_set_flag, AT(pages), NULL},
    CLI_PICTURE_OPTIONS(AT(look)),
    CLI_SIDE_OPTIONS(AT(look)),
    {"positions", 0, "ALL.npy",
     "one array of all deformed positions, jobs x vertices x 3, and ALL.json; meshes need \"out\"",
     cli_set_text, AT(positions), NULL},
    {"dtype", 0, "f4|f8", "numbers of --positions: float32 or float64; default f4", cli_set_choice, AT(type),
     type_names},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static ffd_batch_desc describe(settings *s, const cli_words *words)
{
    const cli_job *const job = &s->jobs.job;
    ffd_batch_desc desc;
    ffd_batch_desc_init(&desc, sizeof desc);
    desc.manifest = words->count ? words->words[0] : NULL;
    desc.csv = s->table;
    desc.csv_ignore = s->ignored;
    desc.in = s->pattern;
    desc.out_dir = s->jobs.out_dir;
    desc.defaults = &job->desc;
    desc.output_ending = s->jobs.output_ending;
    desc.workers = s->at_once;
    desc.timeout = s->timeout;
    desc.shard = s->shard;
    desc.shards = s->shards;
    desc.resume = s->resume;
    desc.journal = s->journal;
    desc.positions = s->positions;
    desc.positions_double = s->type > 0;
    desc.view = s->view;
    desc.pages = s->pages;
    ffd_view_desc_init(&s->drawn, sizeof s->drawn);
    cli_look_describe(&s->look, &s->drawn);
    desc.look = s->view ? &s->drawn : NULL;
    desc.report = job->report;
    desc.report_stable = job->stable;
    desc.depfile = s->jobs.depfile_path;
    desc.shared_box = job->shares_box;
    desc.dry_run = s->dry;
    desc.stop = s->stop;
    desc.quiet = job->logging.quiet;
    desc.verbose = job->logging.verbose;
    desc.is_program = true;
    return desc;
}

/* Returns what is wrong with the options, or NULL. */
static const char *mistake(settings *s, const cli_words *words, const ffd_batch_desc *desc)
{
    if (words->count > 1)
        return "more than one MANIFEST";
    if (s->stop && s->keep_going)
        return "--stop and --keep-going cannot be used together";
    if (s->type >= 0 && !s->positions)
        return "--dtype needs --positions";
    if (!s->view && cli_look_given(&s->look)) {
        snprintf(s->needs, sizeof s->needs, "--%s needs --view", cli_look_given(&s->look));
        return s->needs;
    }
    return ffd_batch_desc_check(desc, &s->jobs.job.refusal) ? s->jobs.job.refusal.message : NULL;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const ffd_batch_desc desc = describe(s, words);
    const char *const why = mistake(s, words, &desc);
    ffd_batch_result result = {.struct_size = sizeof result};
    ffd_error error;
    if (why)
        return cli_usage(command, why);
    if (ffd_batch_run(&desc, &result, &error))
        return cli_fail(&error);
    return result.failed > 0 || !result.is_complete ? EXIT_NO : EXIT_DONE;
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
    {own_options, cli_job_options, cli_deform_options,
     "outputs are named in the manifest, or put into --out-dir DIR"},
    run,
    "MANIFEST",
    examples};
