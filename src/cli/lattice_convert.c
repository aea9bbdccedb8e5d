/* lattice_convert.c - ffd lattice convert: lattices of one format in another. */
#include "cli/author.h"
#include "cli/three.h"
#include <string.h>

typedef struct settings {
    cli_author author;
    ffd_convert_desc convert;
    int order;
} settings;

static bool set_part(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    static const char *const words[] = {
        [FFD_PART_BOTH] = "both", [FFD_PART_REST] = "rest", [FFD_PART_DEFORMED] = "deformed"};
    for (int part = FFD_PART_BOTH; part <= FFD_PART_DEFORMED; part++)
        if (strcmp(value, words[part]) == 0) {
            s->convert.part = (ffd_lattice_part)part;
            return true;
        }
    cli_complain("--%s: \"%.80s\" is not rest, deformed or both", option->name, value);
    return false;
}

static const char *const orders[] = {[FFD_ORDER_UVW] = "uvw", [FFD_ORDER_AUTO] = "auto", NULL};

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"part", 0, "rest|deformed|both", "the states to write; default both, where the format holds both",
     set_part, 0, NULL},
    {"size", 0, "N,M,O", "of an array (n, 3): control points along u, v, w, the first the fastest",
     cli_set_sizes, AT(convert.size), NULL},
    {"degree", 0, "N,M,O",
     "1 to 14, of a format that has none; default 3, or less where there are few points", cli_set_degrees,
     AT(convert.degree), NULL},
    {"order", 0, "uvw|auto",
     "of points: as they stand, or by the points; default uvw, of a .obj without a size auto", cli_set_choice,
     AT(order), orders},
    {"block", 0, "N|TAG", "of a file of several lattices: its number, from 0, or its name", cli_set_text,
     AT(convert.block), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int convert(settings *s, const char *lattice)
{
    const ffd_author_desc job = cli_author_describe(&s->author, lattice);
    ffd_error error;
    s->convert.order = (ffd_point_order)s->order;
    return ffd_lattice_convert_run(&job, &s->convert, &error) ? cli_fail(&error) : EXIT_DONE;
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
    settings s = {.order = FFD_ORDER_DEFAULT};
    ffd_convert_desc_init(&s.convert, sizeof s.convert);
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
                                         "lattices in the formats of other programs, and back",
                                         "usage: ffd lattice convert IN -o OUT [--part rest|deformed|both] "
                                         "[--size N,M,O] [--degree N,M,O] [--order uvw|auto]\n"
                                         "       [--block N|TAG] [options]\n",
                                         {.first = options, .base = cli_author_options},
                                         run,
                                         "LATTICE",
                                         examples};
