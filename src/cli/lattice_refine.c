/* lattice_refine.c - ffd lattice refine: the same map with more control points, or of higher degree. */
#include "cli/author.h"
#include "cli/reported.h"
#include "cli/three.h"
#include <ffd/author.h>
#include <stdlib.h>
#include <string.h>

/* The most knots that one direction gets by --insert. */
#define MOST_KNOTS 1000000

typedef struct settings {
    cli_author author;
    ffd_refine_desc refine;
    double *insert[3];
    cli_report report;
} settings;

/* Adds a knot to a direction. The array doubles. */
static bool add_knot(settings *s, int a, double knot)
{
    const size_t count = s->refine.insert_count[a];
    if ((count & (count - 1)) == 0) {
        double *const more = realloc(s->insert[a], (count ? 2 * count : 1) * sizeof *more);
        if (!more)
            return false;
        s->insert[a] = more;
    }
    s->insert[a][s->refine.insert_count[a]++] = knot;
    return true;
}

/* "u:0.25,0.5" */
static bool add_knots(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    const char *const letters = "uvw", *const letter = *value ? strchr(letters, *value) : NULL;
    const int a = letter ? (int)(letter - letters) : 0;
    const char *at = value + 1;
    bool right = letter && *at == ':';
    while (right && *at) {
        char text[CLI_PART * 2];
        double knot;
        at++;
        const size_t length = strcspn(at, ",");
        right = length < sizeof text && s->refine.insert_count[a] < MOST_KNOTS;
        if (!right)
            break;
        memcpy(text, at, length);
        text[length] = 0;
        right = cli_parse_number(text, &knot) && add_knot(s, a, knot);
        at += length;
    }
    if (!right)
        cli_complain("--%s: \"%.80s\" is not u, v or w and parameters, like u:0.25,0.5", option->name, value);
    return right;
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"size", 0, "N,M,O", "so many control points along u, v, w, or one number for all; not fewer than now",
     cli_set_sizes, AT(refine.size), NULL},
    {"insert", 0, "u:A,B,...", "a knot at each of these parameters of a direction, u, v or w; repeatable",
     add_knots, 0, NULL},
    {"degree", 0, "N,M,O", "1 to 14, three or one for all; not less than now", cli_set_degrees,
     AT(refine.degree), NULL},
    {"report", 0, "FILE|-", "JSON report; JSON Lines if the name ends in .jsonl", cli_set_text,
     AT(report.path), NULL},
    {"report-stable", 0, NULL, "leave the seconds out of the report", cli_set_flag, AT(report.stable), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* Context of refine. */
typedef struct refine_call {
    settings *settings;
    const char *lattice;
} refine_call;

static int refine(void *context, ffd_output_set *files, ffd_report *report)
{
    const refine_call *const call = context;
    settings *const s = call->settings;
    const cli_author *const author = &s->author;
    ffd_author_desc job = cli_author_describe(author, call->lattice);
    ffd_refine_result result = {.struct_size = sizeof result};
    ffd_refine_result *const measured = report || author->logging.verbose ? &result : NULL;
    ffd_error error;
    job.output_set = files;
    for (int a = 0; a < 3; a++)
        s->refine.insert[a] = s->insert[a];
    int code = ffd_lattice_refine_run(&job, &s->refine, measured, &error) ? cli_fail(&error) : EXIT_DONE;
    if (report && ffd_report_add_refine(report, call->lattice, author->output, &result, &error))
        code = cli_fail(&error);
    return code;
}

/* A report replaces an existing report, but must not be a file of the job. */
static const char *wrong_report(const settings *s, const char *lattice)
{
    const char *const why = cli_report_mistake(&s->report, s->author.output);
    if (why)
        return why;
    if (cli_report_meets(&s->report, lattice) || cli_report_meets(&s->report, s->author.output))
        return "the report would replace the lattice";
    for (size_t i = 0; i < s->author.mesh_count; i++)
        if (cli_report_meets(&s->report, s->author.meshes[i].path))
            return "the report would replace a mesh";
    return NULL;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *why = cli_author_mistake(&s->author, words);
    why = why ? why : wrong_report(s, words->words[0]);
    if (why)
        return cli_usage(command, why);
    return cli_author_prepare(&s->author)
               ? cli_run_reported(&s->report, refine, &(refine_call){s, words->words[0]})
               : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    ffd_refine_desc_init(&s.refine, sizeof s.refine);
    const int code = cli_run(command, &s, &s.author.help, count, arguments, act);
    cli_author_end(&s.author);
    for (int a = 0; a < 3; a++)
        free(s.insert[a]);
    return code;
}

static const cli_example examples[] = {
    {"twice as many control points, the same shape",
     "ffd lattice refine bend.json --mesh cow.obj -o fine.json --size 8,12,8"},
    {"more of them in one place",
     "ffd lattice refine bend.json --mesh cow.obj -o local.json --insert v:0.7,0.75,0.8"},
    {"smoother pieces, and how far the maps differ",
     "ffd lattice refine bend.json --mesh cow.obj -o smooth.json --degree 4 --report report.json"},
    {NULL, NULL},
};

const cli_command cli_lattice_refine = {
    "lattice refine",
    "the same map with more control points, or of higher degree",
    "usage: ffd lattice refine LATTICE -o LATTICE [--degree N,M,O] [--insert u:A,B,...]... [--size N,M,O] "
    "[options]\n",
    {.first = options, .base = cli_author_options},
    run,
    "LATTICE",
    examples};
