/* info.c - ffd info: what is in a mesh or lattice file. */
#include "cli/command.h"
#include "cli/member.h"
#include <stdio.h>

typedef struct settings {
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    bool json, parts, help;
    cli_logging logging;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"json", 0, NULL, "as JSON", cli_set_flag, AT(json), NULL},
    {"parts", 0, NULL, "of a mesh: every name that --only takes, with bounds, vertices and faces",
     cli_set_flag, AT(parts), NULL},
    {"set", 0, "NAME=VALUE",
     "of a lattice: value of the placeholder {\"$\": \"NAME\"} in its moves; repeatable", cli_set_member,
     AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "print only errors besides the text", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int describe(settings *s, const char *file)
{
    ffd_info_desc desc;
    ffd_error error;
    char *text;
    ffd_info_desc_init(&desc, sizeof desc);
    desc.file = s->job.input;
    desc.file.path = file;
    desc.json = s->json;
    desc.parts = s->parts;
    desc.set = s->job.set;
    desc.set_count = s->job.set_count;
    desc.log = cli_log;
    desc.log_user = &s->logging;
    if (ffd_info_run(&desc, &text, &error))
        return cli_fail(&error);
    fputs(text, stdout);
    ffd_free(text);
    return EXIT_DONE;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    return words->count == 1 ? describe(context, words->words[0]) : cli_usage(command, "needs one FILE");
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    const int code = cli_run(command, &s, &s.help, count, arguments, act);
    ffd_deform_desc_clear(&s.job);
    return code;
}

static const cli_example examples[] = {
    {"what is in a mesh", "ffd info robot.glb"},
    {"the names of its parts, for --only", "ffd info robot.glb --parts"},
    {"a lattice, for a program to read", "ffd info bend.json --json"},
    {NULL, NULL},
};

const cli_command cli_info = {"info",
                              "what is in a mesh or a lattice file",
                              "usage: ffd info FILE [--json] [--parts] [--set NAME=VALUE]\n",
                              {.first = options},
                              run,
                              "MESH|LATTICE",
                              examples};
