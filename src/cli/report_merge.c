/* report_merge.c - ffd report merge: merges the reports of several runs. */
#include "cli/command.h"

typedef struct settings {
    const char *output;
    bool interleave, force, help;
    cli_logging logging;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"output", 'o', "FILE", "the report to write; default - (standard output)", cli_set_text, AT(output),
     NULL},
    {"interleave", 0, NULL,
     "one job of each report in turn: the order of the manifest, for its shards 0, 1, ...", cli_set_flag,
     AT(interleave), NULL},
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
    if (ffd_report_merge_run(words->words, words->count, s->interleave, s->output ? s->output : "-", s->force,
                             &error))
        return cli_fail(&error);
    return EXIT_DONE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_run(command, &s, &s.help, count, arguments, act);
}

static const cli_example examples[] = {
    {"the reports of the shards of a manifest", "for i in 0 1; do ffd batch jobs.jsonl --shard $i/2 --report "
                                                "$i.json; done; ffd report merge 0.json 1.json"},
    {"in the order of the manifest", "ffd report merge --interleave 0.json 1.json -o all.json"},
    {NULL, NULL},
};

const cli_command cli_report_merge = {
    "report merge",
    "join the reports of several runs to one",
    "usage: ffd report merge REPORT... [-o FILE] [--interleave] [options]\n",
    {.first = options},
    run,
    "REPORT",
    examples};
