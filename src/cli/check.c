/* check.c - ffd check: what a deformation would do, without writing it. */
#include "cli/job.h"
#include "cli/look.h"
#include <stdio.h>

typedef struct settings {
    cli_job job;
    cli_kept kept;
    const char *picture;
    cli_look look; /* of the picture */
    bool force;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"picture", 0, "FILE.png|FILE.html",
     "draw it too, before and after; of one IN (ffd view has more options)", cli_set_text, AT(picture), NULL},
    CLI_SIDE_OPTIONS(AT(look)),
    {"force", 0, NULL, "overwrite an existing picture; else without effect", cli_set_flag, AT(force), NULL},
    CLI_KEPT_OPTIONS(AT(kept)),
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* Prints the figures. Returns the exit code. */
static int print_summary(const cli_job *job, const char *input, const ffd_job_result *result)
{
    ffd_error error;
    char *text = NULL;
    const char *const lattice = job->desc.lattices[result->folds.witness.lattice].path;
    if (ffd_job_result_text(result, cli_display_name(lattice), &text, &error))
        return cli_fail(&error);
    printf("%s\n%s", cli_display_name(input), text);
    ffd_free(text);
    return EXIT_DONE;
}

/* Runs the check, and draws the picture if one is wanted. */
static ffd_status run_job(const settings *s, const ffd_deform_desc *desc, ffd_job_result *result)
{
    ffd_view_desc view;
    if (!s->picture)
        return ffd_check_run(desc, result, NULL);
    ffd_view_desc_init(&view, sizeof view);
    view.job = desc;
    view.output = s->picture;
    view.force = s->force;
    cli_look_describe(&s->look, &view);
    return ffd_view_run(&view, result, NULL);
}

static int check(cli_job *job, const char *input, ffd_report *report)
{
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    cli_job_describe(job, input, &desc);
    const ffd_status status = run_job((settings *)job, &desc, &result);
    const bool reported = job->report && cli_is_stream(job->report);
    int code = EXIT_DONE;
    if ((status == FFD_OK || status == FFD_E_GATE) && !reported && !job->logging.quiet)
        code = print_summary(job, input, &result);
    const int own = cli_job_ended(job, &result, input, NULL, report);
    return own ? own : code;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    char needs[60];
    const char *why = words->count ? cli_job_mistake(&s->job, words, words->count) : "needs IN";
    if (!why && s->picture && words->count > 1)
        why = "--picture is of one mesh, but several IN are given";
    if (!why && s->picture && s->job.report && ffd_paths_meet(s->job.report, s->picture))
        why = "the report would replace the picture";
    if (!why && !s->picture && cli_look_given(&s->look)) {
        snprintf(needs, sizeof needs, "--%s needs --picture", cli_look_given(&s->look));
        why = needs;
    }
    if (why)
        return cli_usage(command, why);
    if (!cli_job_knows_formats(&s->job, words, words->count))
        return EXIT_USAGE;
    return cli_job_run_all(&s->job, words, words->count, check);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"what a deformation would do", "ffd check cow.obj -l bend.json"},
    {"fail where the deformed volume folds, or is not proven not to",
     "ffd check cow.obj vase.obj -l bend.json --fail-on folds --quiet"},
    {NULL, NULL},
};

const cli_command cli_check = {"check",
                               "what a deformation would do: folds, statuses, quality",
                               "usage: ffd check IN... -l LATTICE [-l LATTICE ...] [options]\n"
                               "       exit 1: a gate of --fail-on is violated\n",
                               {.first = cli_job_options, .more = options},
                               run,
                               "MESH",
                               examples};
