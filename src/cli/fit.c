/* fit.c - ffd fit: the lattice that carries points where they are wanted. */
#include "cli/job.h"
#include "cli/reported.h"
#include "cli/three.h"
#include <ctype.h>
#include <ffd/fit.h>
#include <ffd/program.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    ffd_lattice_desc box;
    bool lays; /* an option of the box was given */
    ffd_source *cover;
    size_t cover_count;
    const char *pairs, *output, *weights;
    cli_report report;
    bool handles, robust, has_smooth, has_within, has_space, help;
    int symmetric; /* an index into the letters, -1: not given */
    ffd_fit_smoothing smoothing;
    double smooth;
    cli_distance within;
    cli_logging logging;
    ffd_bar *bar; /* while it works; NULL: none */
} settings;

static bool add_cover(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    return cli_add_file(&s->cover, &s->cover_count, option, value);
}

#define AT(field) offsetof(settings, field)

/* Sets what the box is, and notes that it is laid. */
static bool set_size(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->lays = true;
    return cli_set_sizes(s, option, value);
}

static bool set_degree(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->lays = true;
    return cli_set_degrees(s, option, value);
}

static bool set_knots(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->lays = true;
    return cli_read_knots(s->box.knots, option, value);
}

static bool set_margin(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    bool is_triple;
    s->lays = true;
    return cli_read_margin(s->box.margin, option, value, &is_triple);
}

static bool set_axes(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->lays = s->box.principal = strcmp(value, "principal") == 0;
    if (!s->lays)
        cli_complain("--%s: \"%.80s\" is not principal", option->name, value);
    return s->lays;
}

static bool set_smooth(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->has_smooth = true;
    s->smoothing = strcmp(value, "auto") == 0 ? FFD_FIT_AUTO : FFD_FIT_GIVEN;
    if (s->smoothing == FFD_FIT_AUTO || (cli_parse_number(value, &s->smooth) && s->smooth >= 0))
        return true;
    cli_complain("--%s: \"%.80s\" is neither auto nor a number of at least 0", option->name, value);
    return false;
}

static bool set_within(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->has_within = true;
    s->smoothing = FFD_FIT_WITHIN;
    return cli_set_distance(s, option, value);
}

/* Whether a file is an array, by its name. */
static bool is_array(const char *name)
{
    const size_t length = strlen(name);
    bool is_npy = length > 4;
    for (size_t i = 0; i < 4 && is_npy; i++)
        is_npy = tolower((unsigned char)name[length - 4 + i]) == ".npy"[i];
    return is_npy;
}

static bool set_symmetric(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    if (s->symmetric < 0)
        return cli_set_choice(s, option, value);
    cli_complain("--%s is given twice: a fit is symmetric along one direction", option->name);
    return false;
}

static bool set_space(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->has_space = true;
    return cli_set_member(s, option, value);
}

static bool set_weights(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    if (is_array(value) || strcmp(value, "area") == 0 || strcmp(value, "uniform") == 0)
        return cli_set_text(s, option, value);
    cli_complain("--%s: \"%.80s\" is neither area, uniform nor a file that ends in .npy", option->name,
                 value);
    return false;
}

/* The gate of --fail-on: the others are those of meshes. */
static bool set_gate(void *context, const cli_option *option, const char *value)
{
    return cli_set_member(context, option, value);
}

static const char *const directions[] = {"u", "v", "w", NULL};

static const cli_option options[] = {
    {"output", 'o', "LATTICE", "the file to write; -: standard output", cli_set_text, AT(output), NULL},
    {"pairs", 0, "FILE.csv",
     "pairs: x,y,z the target, px,py,pz or vertex the source, weight a number or exact", cli_set_text,
     AT(pairs), NULL},
    {"handles", 0, NULL, "drag the pairs, and change the rest as little as possible", cli_set_flag,
     AT(handles), NULL},
    {"lattice", 'l', "LATTICE", "the lattice to start from; what it does stays, and the rest is fitted",
     cli_set_member, AT(job), NULL},
    {"size", 0, "N,M,O", "without -l: control points of a box; default 6,6,6", set_size, AT(box.size), NULL},
    {"degree", 0, "N,M,O", "1 to 14, three or one for all; default 3, or less where there are fewer points",
     set_degree, AT(box.degree), NULL},
    {"knots", 0, "K,K,K", "clamped, open, uniform or closed, three or one for all; default open", set_knots,
     0, cli_knots_names},
    {"margin", 0, "F|X,Y,Z", "space on both sides, as a fraction of the extent; default 0.05", set_margin, 0,
     NULL},
    {"axes", 0, "principal", "a box along the principal axes", set_axes, 0, NULL},
    {"cover", 0, "MESH", "the box goes round this too, repeatable: garments of a body", add_cover, 0, NULL},
    {"smooth", 0, "auto|S", "how smooth the rest is, from 0 on, without a unit; default auto", set_smooth, 0,
     NULL},
    {"within", 0, "TOL|TOLr", "the smoothest lattice with all pairs so near (r: parts of the diagonal)",
     set_within, AT(within), NULL},
    {"weights", 0, "area|uniform|FILE.npy", "how much each vertex counts; default the area round it",
     set_weights, AT(weights), NULL},
    {"symmetric", 0, "u|v|w", "pairs count mirrored too, and the lattice is symmetric", set_symmetric,
     AT(symmetric), directions},
    {"robust", 0, NULL, "pairs that are far off count less", cli_set_flag, AT(robust), NULL},
    {"fail-on", 0, "folds", "exit 1, and nothing is written, if the lattice folds", set_gate, AT(job), NULL},
    {"only", 0, "KIND:NAME", "only this of BEFORE, repeatable, as for ffd deform", cli_set_member, AT(job),
     NULL},
    {"space", 0, "scene|mesh", "glTF: the space that the lattice is in; default scene", set_space, AT(job),
     NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(job), NULL},
    {"set", 0, "NAME=VALUE", "value of the placeholder {\"$\": \"NAME\"} in the moves of -l; repeatable",
     cli_set_member, AT(job), NULL},
    {"time", 0, "T", "of -l that has keys: what it is at T seconds", cli_set_member, AT(job), NULL},
    {"report", 0, "FILE|-", "JSON report; JSON Lines if the name ends in .jsonl", cli_set_text,
     AT(report.path), NULL},
    {"report-stable", 0, NULL, "leave the seconds out of the report", cli_set_flag, AT(report.stable), NULL},
    {"force", 0, NULL, "overwrite an existing file", cli_set_member, AT(job), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job), NULL},
    {"isa", 0, "auto|scalar|sse2|avx2|avx512|neon", CLI_ISA, cli_set_member, AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"timeout", 0, "SECONDS", CLI_TIMEOUT, cli_set_member, AT(job), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static ffd_source source_of(const settings *s, const char *path)
{
    ffd_source source = s->job.input;
    source.path = path;
    source.format = cli_is_stream(path) ? source.format : FFD_FORMAT_AUTO;
    return source;
}

/* A message in place of the bar, which is drawn again. */
static void log_line(void *user, ffd_log_level level, const char *message)
{
    settings *const s = user;
    ffd_bar_clear(s->bar);
    cli_log(&s->logging, level, message);
}

static ffd_author_desc describe_author(settings *s, ffd_output_set *files)
{
    ffd_author_desc author;
    ffd_author_desc_init(&author, sizeof author);
    if (s->job.lattice_count > 0)
        author.lattice = s->job.lattices[0];
    author.set = s->job.set;
    author.set_count = s->job.set_count;
    author.time = s->job.time;
    author.has_time = s->job.has_time;
    author.only = s->job.only;
    author.only_count = s->job.only_count;
    author.reading = s->job.input;
    author.threads = s->job.threads;
    author.output = s->output;
    author.force = s->job.force;
    author.output_set = files;
    author.log = log_line;
    author.log_user = (void *)s;
    return author;
}

static ffd_fit_job describe(const settings *s, const ffd_author_desc *author)
{
    ffd_fit_job job;
    ffd_fit_job_init(&job, sizeof job);
    job.job = author;
    job.pairs = s->pairs;
    job.cover = s->cover;
    job.cover_count = s->cover_count;
    job.lattice = s->lays ? &s->box : NULL;
    job.weights = s->weights;
    job.handles = s->handles;
    job.robust = s->robust;
    job.symmetric = s->symmetric + 1;
    job.smoothing = s->smoothing;
    job.smooth = s->smooth;
    job.within = s->within.value;
    job.within_relative = s->within.is_relative;
    job.snap = s->job.snap;
    job.snap_relative = s->job.snap_relative;
    job.fail_on = s->job.fail_on;
    job.isa = s->job.isa;
    job.timeout = s->job.timeout;
    job.progress = s->bar ? ffd_bar_show : NULL;
    job.progress_user = s->bar;
    return job;
}

static void tell(const settings *s, const ffd_fit_job_result *result)
{
    char *text;
    if (s->logging.quiet || ffd_fit_text(result, &text, NULL))
        return;
    cli_complain("%s", text);
    ffd_free(text);
}

/* Context of fit. */
typedef struct fit_call {
    settings *settings;
    const cli_words *words;
} fit_call;

static int fit(void *context, ffd_output_set *files, ffd_report *report)
{
    const fit_call *const call = context;
    settings *const s = call->settings;
    const cli_words *const words = call->words;
    const char *const input = words->count > 0 ? words->words[0] : s->pairs;
    s->bar = s->logging.quiet ? NULL : ffd_bar_create("fit");
    const ffd_author_desc author = describe_author(s, files);
    ffd_fit_job job = describe(s, &author);
    ffd_fit_job_result result = {.struct_size = sizeof result};
    ffd_source before, after;
    ffd_error error;
    if (words->count > 0) {
        before = source_of(s, words->words[0]);
        job.before = &before;
    }
    if (words->count > 1) {
        after = source_of(s, words->words[1]);
        job.after = &after;
    }
    const ffd_status status = ffd_fit_run(&job, &result, &error);
    ffd_bar_destroy(&s->bar);
    int code = status ? cli_fail(&error) : EXIT_DONE;
    if (code == EXIT_DONE)
        tell(s, &result);
    if (report && ffd_report_add_fit(report, input, s->output, &result, &error))
        code = cli_fail(&error);
    return code;
}

/* A report replaces an existing report, but must not be a file of the job. */
static const char *wrong_report(const settings *s, const cli_words *words)
{
    const char *const why = cli_report_mistake(&s->report, s->output);
    if (why)
        return why;
    bool meets = cli_report_meets(&s->report, s->output) || cli_report_meets(&s->report, s->pairs) ||
                 cli_report_meets(&s->report, s->weights);
    for (size_t i = 0; i < words->count; i++)
        meets = meets || cli_report_meets(&s->report, words->words[i]);
    for (size_t i = 0; i < s->cover_count; i++)
        meets = meets || cli_report_meets(&s->report, s->cover[i].path);
    for (size_t i = 0; i < s->job.lattice_count; i++)
        meets = meets || cli_report_meets(&s->report, s->job.lattices[i].path);
    return meets ? "the report would replace a file of the job" : NULL;
}

static size_t count_streams(const settings *s, const cli_words *words)
{
    size_t streams = s->pairs && cli_is_stream(s->pairs);
    for (size_t i = 0; i < words->count; i++)
        streams += cli_is_stream(words->words[i]);
    for (size_t i = 0; i < s->job.lattice_count; i++)
        streams += cli_is_stream(s->job.lattices[i].path);
    return streams;
}

/* What is wrong with the pairs, or NULL. */
static const char *wrong_pairs(const settings *s, const cli_words *words)
{
    if (s->pairs && words->count > 1)
        return "--pairs has the targets: it goes with BEFORE alone, or without";
    if (!s->pairs && words->count != 2)
        return "needs BEFORE and AFTER, or --pairs FILE.csv";
    if (s->handles && !s->pairs)
        return "--handles needs --pairs";
    if (s->weights && s->pairs)
        return "--weights is for BEFORE and AFTER: the rows of --pairs have their own";
    if (s->robust && s->handles)
        return "--robust does not go with --handles";
    if (s->has_space && words->count > 0 && is_array(words->words[0]))
        return "--space is for a mesh: BEFORE is an array";
    return s->job.only_count > 0 && words->count == 0 ? "--only needs BEFORE" : NULL;
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(const settings *s, const cli_words *words)
{
    const char *const why = wrong_pairs(s, words);
    if (why)
        return why;
    if (!s->output)
        return "no output is given (-o LATTICE)";
    if (s->job.lattice_count > 1)
        return "a fit starts from one lattice, not several";
    if (s->job.lattice_count > 0 && s->lays)
        return "-l has its own size, degree, knots and box: --size, --degree, --knots, --margin and --axes "
               "are for "
               "a box without it";
    if (s->job.lattice_count == 0 && (s->job.set_count > 0 || s->job.has_time))
        return "--set and --time need -l LATTICE";
    if (s->has_smooth && s->has_within)
        return "--smooth and --within cannot be used together";
    if (s->job.fail_on & ~(unsigned)FFD_GATE_FOLDS)
        return "--fail-on of a fit can be folds only";
    if (count_streams(s, words) > 1)
        return "standard input can be read only once";
    return wrong_report(s, words);
}

/* Whether the formats of all meshes are known, and gives them the options for reading. BEFORE and AFTER may
   be arrays. */
static bool prepare(settings *s, const cli_words *words)
{
    for (size_t i = 0; i < words->count; i++) {
        if (!is_array(words->words[i]) &&
            !cli_knows_format(words->words[i],
                              cli_is_stream(words->words[i]) ? s->job.input.format : FFD_FORMAT_AUTO))
            return false;
    }
    for (size_t i = 0; i < s->cover_count; i++) {
        if (!cli_knows_format(s->cover[i].path, FFD_FORMAT_AUTO))
            return false;
        s->cover[i] = source_of(s, s->cover[i].path);
    }
    return true;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    return prepare(s, words) ? cli_run_reported(&s->report, fit, &(fit_call){s, words}) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {.symmetric = -1};
    ffd_lattice_desc_init(&s.box, sizeof s.box);
    for (int a = 0; a < 3; a++) {
        s.box.size[a] = 6;
        s.box.knots[a] = FFD_KNOTS_OPEN;
    }
    const int code = cli_run(command, &s, &s.help, count, arguments, act);
    free(s.cover);
    ffd_deform_desc_clear(&s.job);
    return code;
}

static const cli_example examples[] = {
    {"what another program did to a mesh, as a lattice", "ffd fit cow.obj posed.obj -o found.json"},
    {"the same, no vertex farther off than a thousandth of the mesh",
     "ffd fit cow.obj posed.obj -o near.json --size 8,8,8 --within 1e-3r --report fit.json"},
    {"vertices that are dragged, and a table of them",
     "ffd fit cow.obj --pairs pairs.csv --handles -o dragged.json"},
    {NULL, NULL},
};

const cli_command cli_fit = {
    "fit",
    "the lattice that carries points where they are wanted",
    "usage: ffd fit BEFORE AFTER -o LATTICE [-l LATTICE | --size 6,6,6 [--degree 3,3,3]] [options]\n"
    "       ffd fit [BEFORE] --pairs FILE.csv [--handles] -o LATTICE [options]\n",
    {.first = options},
    run,
    "MESH",
    examples};
