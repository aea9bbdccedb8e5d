/* report_junit.c - ffd report junit: reports for build servers. */
#include "cli/command.h"

typedef struct settings {
    const char *output;
    bool force, help;
    cli_logging logging;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"output", 'o', "FILE.xml", "the file to write; default - (standard output)", cli_set_text, AT(output),
     NULL},
    {"force", 0, NULL, "overwrite an existing file", cli_set_flag, AT(force), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int act(const cli_command *command, void *context, const cli_words *words)
{
    const settings *s = context;
    ffd_error error;
    const int wrong = cli_check_reports(command, words);
    if (wrong)
        return wrong;
    if (ffd_report_junit_run(words->words, words->count, s->output ? s->output : "-", s->force, &error))
        return cli_fail(&error);
    return EXIT_DONE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_run(command, &s, &s.help, count, arguments, act);
}

static const cli_example examples[] = {
    {"a report for a build server", "ffd check cow.obj -l twist.json --fail-on folds --report report.json "
                                    "-q; ffd report junit report.json -o "
                                    "report.xml"},
    {"a comparison of two folders", "mkdir -p a b; cp cow.obj a; cp cow.obj b; ffd compare a b --recursive "
                                    "--json >c.json; ffd report junit c.json"},
    {NULL, NULL},
};

const cli_command cli_report_junit = {"report junit",
                                      "reports and comparisons as JUnit XML",
                                      "usage: ffd report junit REPORT... -o FILE.xml [options]\n",
                                      {.first = options},
                                      run,
                                      "REPORT",
                                      examples};
