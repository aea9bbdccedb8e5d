/* lattice_convert.c - ffd lattice convert: lattices of one format in another. */
#include "cli/author.h"
#include "cli/three.h"
#include <limits.h>
#include <string.h>

typedef struct settings {
    cli_author author;
    size_t size[3];
    int degree[3];
    ffd_lattice_part part;
} settings;

/* Parses three whole numbers with commas between them, or one for all. */
static bool parse_three(const cli_option *option, const char *value, long least, long greatest,
                        long numbers[3])
{
    char part[3][CLI_PART];
    bool right = cli_split_three(value, part);
    for (int a = 0; right && a < 3; a++)
        right = cli_parse_count(part[a], least, greatest, &numbers[a]);
    if (!right && greatest < LONG_MAX)
        cli_complain("--%s: \"%.80s\" is not three whole numbers from %ld to %ld, like 3,3,3", option->name,
                     value, least, greatest);
    else if (!right)
        cli_complain("--%s: \"%.80s\" is not three whole numbers of at least %ld, like 8,8,8", option->name,
                     value, least);
    return right;
}

static bool set_size(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    long numbers[3];
    if (!parse_three(option, value, 2, LONG_MAX, numbers))
        return false;
    for (int a = 0; a < 3; a++)
        s->size[a] = (size_t)numbers[a];
    return true;
}

static bool set_degree(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    long numbers[3];
    if (!parse_three(option, value, 1, FFD_MAX_DEGREE, numbers))
        return false;
    for (int a = 0; a < 3; a++)
        s->degree[a] = (int)numbers[a];
    return true;
}

static bool set_part(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    static const char *const words[] = {
        [FFD_PART_BOTH] = "both", [FFD_PART_REST] = "rest", [FFD_PART_DEFORMED] = "deformed"};
    for (int part = FFD_PART_BOTH; part <= FFD_PART_DEFORMED; part++)
        if (strcmp(value, words[part]) == 0) {
            s->part = (ffd_lattice_part)part;
            return true;
        }
    cli_complain("--%s: \"%.80s\" is not rest, deformed or both", option->name, value);
    return false;
}

static const cli_option options[] = {
    {"part", 0, "rest|deformed|both", "the states to write; default both, where the format holds both",
     set_part, 0, NULL},
    {"size", 0, "N,M,O", "of an array (n, 3): control points along u, v, w, the first the fastest", set_size,
     0, NULL},
    {"degree", 0, "N,M,O",
     "1 to 14, of a format that has none; default 3, or less where there are few points", set_degree, 0,
     NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int convert(settings *s, const char *lattice)
{
    const cli_author *const author = &s->author;
    ffd_lattice_convert_desc desc;
    ffd_error error;
    ffd_lattice_convert_desc_init(&desc, sizeof desc);
    desc.lattice.path = lattice;
    desc.set = author->job.set;
    desc.set_count = author->job.set_count;
    desc.meshes = author->meshes;
    desc.mesh_count = author->mesh_count;
    desc.only = author->job.only;
    desc.only_count = author->job.only_count;
    desc.reading = author->job.input;
    memcpy(desc.size, s->size, sizeof desc.size);
    memcpy(desc.degree, s->degree, sizeof desc.degree);
    desc.part = s->part;
    desc.output = author->output;
    desc.force = author->job.force;
    desc.log = cli_log;
    desc.log_user = (void *)&author->logging;
    return ffd_lattice_convert_run(&desc, &error) ? cli_fail(&error) : EXIT_DONE;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = cli_author_mistake(&s->author, words);
    if (why)
        return cli_usage(command, why);
    return cli_author_prepare(&s->author) ? convert(s, words->words[0]) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    const int code = cli_run(command, &s, &s.author.help, count, arguments, act);
    cli_author_end(&s.author);
    return code;
}

static const cli_example examples[] = {
    {"a table for a spreadsheet or a script", "ffd lattice convert bend.json --mesh cow.obj -o bend.csv"},
    {"the deformed control points for NumPy",
     "ffd lattice convert bend.json --mesh cow.obj -o bend.npy --part deformed"},
    {"a lattice file of an array", "ffd lattice convert bend.npy -o bent.json"},
    {NULL, NULL},
};

const cli_command cli_lattice_convert = {"lattice convert",
                                         "lattices as tables and arrays, and back: .json, .csv, .npy",
                                         "usage: ffd lattice convert IN -o OUT [--part rest|deformed|both] "
                                         "[--size N,M,O] [--degree N,M,O] [options]\n",
                                         {.first = options, .base = cli_author_options},
                                         run,
                                         "LATTICE",
                                         examples};
