/* info.c - ffd info: what is in a mesh or lattice file. */
#include "cli/command.h"
#include <stdio.h>

typedef struct settings {
    ffd_format input_format;
    uint64_t memory;
    bool json, help;
    cli_logging logging; /* the text itself is data: nothing is left to be silent about, or to add */
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"json", 0, NULL, "as JSON", cli_set_flag, AT(json), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_bytes, AT(memory), NULL},
    {"input-format", 0, "FORMAT", CLI_FORMATS "; needed for -", cli_set_format, AT(input_format), NULL},
    {"quiet", 'q', NULL, "print only errors besides the text", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int describe(const settings *s, const char *file)
{
    const ffd_source source = {.path = file, .format = s->input_format, .memory = s->memory};
    ffd_error error;
    char *text;
    if (ffd_info_run(&source, s->json, &text, &error))
        return cli_fail(&error);
    fputs(text, stdout);
    ffd_text_free(text);
    return EXIT_DONE;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    return words->count == 1 ? describe(context, words->words[0]) : cli_usage(command, "needs one FILE");
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_run(command, &s, &s.help, count, arguments, act);
}

static const cli_example examples[] = {
    {"what is in a mesh", "ffd info robot.glb"},
    {"a lattice, for a program to read", "ffd info bend.json --json"},
    {NULL, NULL},
};

const cli_command cli_info = {"info",
                              "what is in a mesh or a lattice file",
                              "usage: ffd info FILE [--json]\n",
                              {.first = options},
                              run,
                              "MESH|LATTICE",
                              examples};
