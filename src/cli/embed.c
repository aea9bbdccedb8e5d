/* embed.c - ffd embed: u,v,w of every vertex as a NumPy file. */
#include "cli/job.h"
#include <string.h>

typedef struct settings {
    const char *lattice, *output, *status;
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    bool help;
    cli_logging logging;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"lattice", 'l', "LATTICE", "lattice file; it needs no moves, and no values for placeholders in them",
     cli_set_text, AT(lattice), NULL},
    {"set", 0, "NAME=VALUE", "value of the placeholder {\"$\": \"NAME\"} in the moves; repeatable",
     cli_set_member, AT(job), NULL},
    {"output", 'o', "FILE.npy", "u,v,w: float64, N x 3, NaN where outside; statuses and hashes after it",
     cli_set_text, AT(output), NULL},
    {"status", 0, "FILE.npy", "uint8 for each vertex: 0 inside, 1 outside, 2 multiple, 3 singular, 4 invalid",
     cli_set_text, AT(status), NULL},
    {"space", 0, "scene|mesh", "glTF: the space that the lattice is in; default scene", cli_set_member,
     AT(job), NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(job), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job), NULL},
    {"force", 0, NULL, "overwrite existing outputs", cli_set_member, AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int embed(settings *s, const char *input)
{
    ffd_embed_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    ffd_embed_desc_init(&desc, sizeof desc);
    desc.input = s->job.input;
    desc.input.path = input;
    desc.lattice.path = s->lattice;
    desc.set = s->job.set;
    desc.set_count = s->job.set_count;
    desc.output = s->output;
    desc.status_output = s->status;
    desc.snap = s->job.snap;
    desc.snap_relative = s->job.snap_relative;
    desc.threads = s->job.threads;
    desc.force = s->job.force;
    desc.log = cli_log;
    desc.log_user = &s->logging;
    s->logging.subject = input;
    return ffd_embed_run(&desc, &result, &error) ? cli_fail(&error) : EXIT_DONE;
}

/* --force replaces older outputs, but never an input. */
static bool replaces_input(const settings *s, const char *output, const char *mesh)
{
    return output && strcmp(output, "-") != 0 &&
           (strcmp(output, mesh) == 0 || strcmp(output, s->lattice) == 0);
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(const settings *s, const cli_words *words)
{
    if (words->count != 1)
        return "needs one IN";
    if (!s->lattice)
        return "no lattice is given (-l FILE)";
    if (!s->output)
        return "no output is given (-o FILE.npy)";
    if (strcmp(words->words[0], "-") == 0 && strcmp(s->lattice, "-") == 0)
        return "standard input can be read only once";
    if (s->status && strcmp(s->output, s->status) == 0)
        return "-o and --status name the same file";
    if (replaces_input(s, s->output, words->words[0]) || replaces_input(s, s->status, words->words[0]))
        return "the output would replace an input";
    return NULL;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *s = context;
    const char *why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    return cli_knows_format(words->words[0], s->job.input.format) ? embed(s, words->words[0]) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    const int code = cli_run(command, &s, &s.help, count, arguments, act);
    ffd_deform_desc_clear(&s.job);
    return code;
}

static const cli_example examples[] = {
    {"u,v,w and the status of every vertex",
     "ffd embed cow.obj -l bend.json -o cow.npy --status cow-status.npy"},
    {"embed once, deform often", "ffd embed vase.obj -l bend.json -o vase.npy && ffd deform vase.obj "
                                 "bent.obj -l bend.json --embedding vase.npy"},
    {NULL, NULL},
};

const cli_command cli_embed = {"embed",
                               "u,v,w of every vertex",
                               "usage: ffd embed IN -l LATTICE -o FILE.npy [--status FILE.npy] [options]\n",
                               {.first = options},
                               run,
                               "MESH",
                               examples};
